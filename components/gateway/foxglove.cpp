#include "components/gateway/foxglove.hpp"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace swivel {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSubscriptions = 64;
constexpr char kMessageData = 0x01;
constexpr int kStatusWarning = 1;

// A number that fits an id; none for anything else.
std::optional<std::uint32_t> id_in(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> id_in(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return std::nullopt;
  return id_in(object[key]);
}

std::string status(const std::string& words) {
  return json{{"op", "status"}, {"level", kStatusWarning}, {"message", words}}.dump();
}

const json& list_in(const json& request, const char* key) {
  static const json none = json::array();
  const auto found = request.find(key);
  return found != request.end() && found->is_array() ? *found : none;
}

template <std::size_t kBytes>
void append_little_endian(std::string& bytes, std::uint64_t value) {
  for (std::size_t place = 0; place < kBytes; ++place)
    bytes += static_cast<char>(value >> (8 * place) & 0xFFU);
}

}  // namespace

bool is_foxglove(const std::string& sub_protocol) {
  return sub_protocol == "foxglove.websocket.v1" || sub_protocol == "foxglove.sdk.v1";
}

std::vector<std::string> foxglove_greeting(const std::string& server_name,
                                           const std::vector<FoxgloveChannel>& channels) {
  json list = json::array();
  for (const FoxgloveChannel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  const json info{{"op", "serverInfo"},
                  {"name", server_name},
                  {"capabilities", json::array()},
                  {"metadata", json::object()}};
  return {info.dump(), json{{"op", "advertise"}, {"channels", list}}.dump()};
}

std::string foxglove_message_head(std::uint32_t subscription, std::int64_t time_ns) {
  std::string head(1, kMessageData);
  append_little_endian<4>(head, subscription);
  append_little_endian<8>(head, static_cast<std::uint64_t>(time_ns));
  return head;
}

std::string FoxgloveSubscriptions::take(const std::string& text) {
  const json request = json::parse(text, nullptr, false);
  if (!request.is_object()) return status("this is no JSON object");
  const auto op = request.find("op");
  const bool subscribes = op != request.end() && *op == "subscribe";
  if (!subscribes && (op == request.end() || *op != "unsubscribe"))
    return status("only subscribe and unsubscribe are known here");
  std::string problem;
  for (const json& wish : list_in(request, subscribes ? "subscriptions" : "subscriptionIds")) {
    const auto subscription = subscribes ? id_in(wish, "id") : id_in(wish);
    const auto channel = subscribes ? id_in(wish, "channelId") : std::optional(0U);
    if (!subscription || !channel) return status("an id is missing or no number");
    if (!subscribes) channel_of_.erase(*subscription);
    if (subscribes) problem = subscribe(*subscription, *channel);
    if (!problem.empty()) return status(problem);
  }
  return {};
}

std::string FoxgloveSubscriptions::subscribe(std::uint32_t subscription, std::uint32_t channel) {
  if (channel >= channel_count_) return "there is no channel " + std::to_string(channel);
  if (channel_of_.size() >= kMostSubscriptions) return "too many subscriptions";
  if (!channel_of_.emplace(subscription, channel).second)
    return "subscription " + std::to_string(subscription) + " is there already";
  return {};
}

std::vector<std::uint32_t> FoxgloveSubscriptions::to(std::uint32_t channel) const {
  std::vector<std::uint32_t> subscriptions;
  for (const auto& [subscription, subscribed] : channel_of_)
    if (subscribed == channel) subscriptions.push_back(subscription);
  return subscriptions;
}

}  // namespace swivel
