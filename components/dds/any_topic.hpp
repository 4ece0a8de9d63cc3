// Topics whose type is not known until the program runs, and their samples as they go over the
// wire: what a recorder takes and a player gives back, byte for byte.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/dds/participant.hpp"

namespace swivel {

struct AnyTopic {
  const char* name;
  bool for_ros;
  eprosima::fastdds::dds::TypeSupport (*make_type)();

  std::string full_name(const std::string& rig) const {
    return Topic<void>{name, for_ros}.full_name(rig);
  }
  template <class Message>
  bool is(const Topic<Message>& topic) const {
    return std::string_view(name) == topic.name;
  }
};

const std::vector<AnyTopic>& all_topics();

// The topic of a full name, and the rig's; none where it is no topic of ours.
struct RigTopic {
  AnyTopic topic;
  std::string rig;
};
std::optional<RigTopic> find_topic(const std::string& full_name);

// CDR with its heading of four bytes.
class CdrWriter : public AnyWriter {
 public:
  CdrWriter(Participant& participant, const AnyTopic& topic);
  bool write(const std::string& cdr);
};

// False where the bytes are no such message; they may say anything where the type is a wary one.
bool decode_cdr(eprosima::fastdds::dds::TopicDataType& type, std::string_view cdr, void* message);

template <class Message>
std::optional<Message> decode_cdr(std::string_view cdr) {
  WaryType<Message> type(std::make_shared<Refusals>());
  Message message;
  if (!decode_cdr(type, cdr, &message)) return std::nullopt;
  return message;
}

std::string encode_cdr(eprosima::fastdds::dds::TopicDataType& type, const void* message);

template <class Message>
std::string encode_cdr(const Message& message) {
  typename TypeSupportOf<Message>::Type type;
  return encode_cdr(type, &message);
}

}  // namespace swivel
