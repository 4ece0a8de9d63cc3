#include "components/swivel/recorder/replay_source.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "components/mcap/reader.hpp"
#include "components/recording/mcap_recording.hpp"
#include "components/swivel/recorder/time_filter.hpp"

namespace swivel {
namespace {

const AnyTopic& topic_named(std::string_view name) {
  const auto& topics = all_topics();
  return *std::find_if(topics.begin(), topics.end(),
                       [name](const AnyTopic& topic) { return topic.name == name; });
}

const char* topic_of(const msg::ScanLine&) {
  return kScanLineTopic.name;
}
const char* topic_of(const msg::Axis&) {
  return kAxisTopic.name;
}
const char* topic_of(const msg::Sweep&) {
  return kSweepTopic.name;
}
const char* topic_of(const msg::Calibration&) {
  return kCalibrationTopic.name;
}

class McapSource {
 public:
  McapSource(McapReader reader, std::vector<std::string> topics, const TimeWindow& window)
      : reader_(std::move(reader)), topics_(std::move(topics)), filter_(window) {}

  Result<std::optional<ReplayMessage>> next() {
    while (const auto message = reader_.next()) {
      const McapChannel& channel = reader_.channel(message->channel_id);
      if (!filter_.takes(channel.topic, message->log_time_ns)) continue;
      const auto known = find_topic(channel.topic);
      if (!known || channel.message_encoding != "cdr") continue;
      const AnyTopic& topic = topic_named(known->topic.name);
      if (!wanted(channel.topic, topic, message->data)) continue;
      return std::optional<ReplayMessage>(
          ReplayMessage{message->log_time_ns, &topic, std::string(message->data)});
    }
    if (reader_.damage().none()) return std::optional<ReplayMessage>();
    return Failure{in_words(reader_.damage())};
  }

 private:
  bool wanted(const std::string& name, const AnyTopic& topic, std::string_view cdr) const {
    if (topics_.empty()) return !comes_from_the_stages(topic, cdr);
    return std::find(topics_.begin(), topics_.end(), name) != topics_.end();
  }

  static std::string in_words(const McapDamage& damage) {
    const std::string what =
        damage.reasons.empty() ? "it was never closed" : damage.reasons.front();
    return "the recording is not whole, and what could be read was played: " + what +
           "; see: swivel check";
  }

  McapReader reader_;
  std::vector<std::string> topics_;
  TimeFilter filter_;
};

}  // namespace

ReplaySource play_case(Recording recording) {
  const auto shared = std::make_shared<Recording>(std::move(recording));
  return [shared]() -> Result<std::optional<ReplayMessage>> {
    const auto event = shared->next();
    if (!event) return Failure{event.reason()};
    if (!event->has_value()) return std::optional<ReplayMessage>();
    return std::visit(
        [&](const auto& message) {
          return std::optional<ReplayMessage>(ReplayMessage{
              (*event)->time_ns, &topic_named(topic_of(message)), encode_cdr(message)});
        },
        (*event)->message);
  };
}

ReplaySource play_mcap(const std::string& path, const std::vector<std::string>& topics,
                       const TimeWindow& window) {
  auto reader = McapReader::open(path);
  if (!reader) {
    return [reason = reader.reason()]() -> Result<std::optional<ReplayMessage>> {
      return Failure{reason};
    };
  }
  const auto source = std::make_shared<McapSource>(std::move(*reader), topics, window);
  return [source] { return source->next(); };
}

}  // namespace swivel
