// What the participants count, as Prometheus reads it.
#pragma once

#include <map>
#include <string>

#include "components/common/roll.hpp"

namespace swivel {

std::string metrics_text(const std::map<std::string, RollEntry>& participants,
                         std::chrono::steady_clock::time_point now);

}  // namespace swivel
