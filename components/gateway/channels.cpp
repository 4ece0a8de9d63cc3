#include "components/gateway/channels.hpp"

#include "components/dds/topic_schema.hpp"

namespace swivel {
namespace {

template <class Message>
FoxgloveChannel channel(ChannelId id, const Topic<Message>& topic, const std::string& rig) {
  const std::string name = topic.full_name(rig);
  const TopicSchema schema = schema_of(find_topic(name)->topic);
  return {id, name, schema.name, schema.encoding, schema.text};
}

}  // namespace

std::vector<FoxgloveChannel> foxglove_channels(const std::string& rig) {
  return {channel(kScanLineChannel, kScanLineTopic, rig),
          channel(kAxisChannel, kAxisTopic, rig),
          channel(kSweepChannel, kSweepTopic, rig),
          channel(kAttitudeChannel, kAttitudeTopic, rig),
          channel(kCalibrationChannel, kCalibrationTopic, rig),
          channel(kHealthChannel, kHealthTopic, rig),
          channel(kCloudChannel, kCloudTopic, rig)};
}

}  // namespace swivel
