// Our topics as channels of an MCAP file: the definition of their type goes with them, so that
// programs of others can decode them.
#pragma once

#include <string>

#include "components/dds/any_topic.hpp"
#include "components/mcap/format.hpp"

namespace swivel {

// What a channel's metadata says of its writer.
inline constexpr const char* kParticipantKey = "participant";
inline constexpr const char* kWriterKey = "writer";

McapChannel channel_of(const AnyTopic& topic, const std::string& rig, const CdrSample& sample);

}  // namespace swivel
