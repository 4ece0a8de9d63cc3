#include "components/swivel/recorder/channels.hpp"

#include "components/dds/topic_schema.hpp"

namespace swivel {

McapChannel channel_of(const AnyTopic& topic, const std::string& rig, const CdrSample& sample) {
  const TopicSchema schema = schema_of(topic);
  return {topic.full_name(rig),
          "cdr",
          {schema.name, schema.encoding, schema.text},
          {{kParticipantKey, sample.participant}, {kWriterKey, sample.writer}}};
}

}  // namespace swivel
