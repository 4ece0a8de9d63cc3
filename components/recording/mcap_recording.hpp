// A recording of a live rig, as swivel record makes it: what the hardware sent is played, and the
// calibration; what the stages made of it they make again.
#pragma once

#include <string>
#include <string_view>

#include "components/dds/any_topic.hpp"
#include "components/recording/recording.hpp"

namespace swivel {

Result<Recording> open_mcap_recording(const std::string& path);

// Of the first topic of ours. Fails where there is none.
Result<std::string> rig_in_mcap(const std::string& path);

// Whether the message is made by the stages of others.
bool comes_from_the_stages(const AnyTopic& topic, std::string_view cdr);

}  // namespace swivel
