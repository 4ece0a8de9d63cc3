#include "components/swivel/recorder/overview.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "components/swivel/recorder/channels.hpp"

namespace swivel {
namespace {

double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

std::string participant_of(const McapChannel& channel) {
  const auto name = channel.metadata.find(kParticipantKey);
  return name == channel.metadata.end() ? "" : name->second;
}

}  // namespace

void ChannelOverview::add(const McapMessage& message) {
  if (messages == 0) first_ns = last_ns = message.log_time_ns;
  longest_pause_s = std::max(longest_pause_s, seconds(message.log_time_ns) - seconds(last_ns));
  first_ns = std::min(first_ns, message.log_time_ns);
  last_ns = std::max(last_ns, message.log_time_ns);
  sequence.add(message.sequence);
  bytes += message.data.size();
  ++messages;
}

std::uint64_t Overview::messages() const {
  std::uint64_t sum = 0;
  for (const ChannelOverview& channel : channels) sum += channel.messages;
  return sum;
}

std::uint64_t Overview::missing() const {
  std::uint64_t sum = 0;
  for (const ChannelOverview& channel : channels) sum += channel.sequence.missing();
  return sum;
}

double Overview::duration_s() const {
  if (channels.empty()) return 0.0;
  std::int64_t first_ns = INT64_MAX;
  std::int64_t last_ns = INT64_MIN;
  for (const ChannelOverview& channel : channels) {
    first_ns = std::min(first_ns, channel.first_ns);
    last_ns = std::max(last_ns, channel.last_ns);
  }
  return seconds(last_ns) - seconds(first_ns);
}

Result<Overview> look_at(const std::string& path) {
  auto reader = McapReader::open(path);
  if (!reader) return Failure{reader.reason()};
  std::map<std::uint16_t, ChannelOverview> channels;
  while (const auto message = reader->next()) {
    ChannelOverview& channel = channels[message->channel_id];
    if (channel.messages == 0) channel.channel = reader->channel(message->channel_id);
    channel.add(*message);
  }
  Overview overview{path, reader->size_bytes(), reader->chunks(), {}, reader->damage()};
  for (auto& [id, channel] : channels) overview.channels.push_back(std::move(channel));
  std::stable_sort(overview.channels.begin(), overview.channels.end(),
                   [](const auto& a, const auto& b) { return a.channel.topic < b.channel.topic; });
  return overview;
}

std::string overview_in_words(const Overview& overview) {
  std::string words = fmt::format("{}: {:.1f} s, {} messages, {} chunks, {:.1f} MB{}\n",
                                  overview.path, overview.duration_s(), overview.messages(),
                                  overview.chunks, static_cast<double>(overview.size_bytes) * 1e-6,
                                  overview.damage.closed ? "" : "; it was not closed");
  for (const ChannelOverview& channel : overview.channels) {
    const double duration_s = seconds(channel.last_ns) - seconds(channel.first_ns);
    const double rate_hz =
        duration_s > 0.0 ? static_cast<double>(channel.messages - 1) / duration_s : 0.0;
    words +=
        fmt::format("{:<24} {:<28} {:>7} messages {:>8.2f} Hz {:>8.1f} MB, longest pause {:.2f} s",
                    channel.channel.topic, participant_of(channel.channel), channel.messages,
                    rate_hz, static_cast<double>(channel.bytes) * 1e-6, channel.longest_pause_s);
    if (channel.sequence.missing() > 0) {
      words += fmt::format(", {} missing", channel.sequence.missing());
    }
    words += '\n';
  }
  return words;
}

nlohmann::ordered_json overview_json(const Overview& overview) {
  nlohmann::ordered_json json{{"path", overview.path},
                              {"size_bytes", overview.size_bytes},
                              {"duration_s", overview.duration_s()},
                              {"messages", overview.messages()},
                              {"missing", overview.missing()},
                              {"chunks", overview.chunks},
                              {"damaged_chunks", overview.damage.damaged_chunks},
                              {"skipped_bytes", overview.damage.skipped_bytes},
                              {"closed", overview.damage.closed},
                              {"damage", overview.damage.reasons},
                              {"channels", nlohmann::ordered_json::array()}};
  for (const ChannelOverview& channel : overview.channels) {
    json["channels"].push_back({{"topic", channel.channel.topic},
                                {"type", channel.channel.schema.name},
                                {"participant", participant_of(channel.channel)},
                                {"messages", channel.messages},
                                {"bytes", channel.bytes},
                                {"first_ns", channel.first_ns},
                                {"last_ns", channel.last_ns},
                                {"longest_pause_s", channel.longest_pause_s},
                                {"missing", channel.sequence.missing()},
                                {"out_of_order", channel.sequence.repeated()}});
  }
  return json;
}

}  // namespace swivel
