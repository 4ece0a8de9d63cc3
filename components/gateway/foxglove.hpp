// The Foxglove WebSocket protocol, server side: channels are advertised with their schemas, a
// client subscribes to some, and gets their messages in binary.
//
//   message = 0x01, uint32 subscription id, uint64 time in ns, the message; little endian
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace swivel {

struct FoxgloveChannel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;
  std::string schema_encoding;  // "omgidl", "ros2msg"
  std::string schema;
};

// The sub-protocols that mean this protocol.
bool is_foxglove(const std::string& sub_protocol);

// What a client is told first.
std::vector<std::string> foxglove_greeting(const std::string& server_name,
                                           const std::vector<FoxgloveChannel>& channels);

std::string foxglove_message_head(std::uint32_t subscription, std::int64_t time_ns);

// What one client has subscribed to. Takes any text.
class FoxgloveSubscriptions {
 public:
  explicit FoxgloveSubscriptions(std::size_t channel_count) : channel_count_(channel_count) {}

  // Empty, or a status message that tells the client what was wrong.
  [[nodiscard]] std::string take(const std::string& text);

  // The ids that the client gave its subscriptions to that channel.
  std::vector<std::uint32_t> to(std::uint32_t channel) const;

 private:
  std::string subscribe(std::uint32_t subscription, std::uint32_t channel);

  std::size_t channel_count_;
  std::map<std::uint32_t, std::uint32_t> channel_of_;  // by subscription
};

}  // namespace swivel
