// The schemas of the topics in words, for those who read CDR without this program: recordings and
// Foxglove's clients.
#pragma once

#include <string>

#include "components/dds/any_topic.hpp"

namespace swivel {

struct TopicSchema {
  std::string name;      // of the type
  std::string encoding;  // "omgidl", "ros2msg"
  std::string text;
};

TopicSchema schema_of(const AnyTopic& topic);

}  // namespace swivel
