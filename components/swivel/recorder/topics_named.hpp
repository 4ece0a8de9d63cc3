// Topics as a user names them.
#pragma once

#include <string>
#include <vector>

#include "components/dds/any_topic.hpp"

namespace swivel {

// "cloud" and "rt/swivel/cloud" name the same; no names, all topics but the wires. Throws ExitError
// for one that there is not.
std::vector<AnyTopic> topics_named(const std::vector<std::string>& names, const std::string& rig);

}  // namespace swivel
