// What of its surroundings a rig sees twice, and which lines do.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/sweep_readings.hpp"

namespace swivel {

// Of which view of the surroundings a line is: the halves of a full turn, or the sweeps up and
// down. What lies at angles that only one of them passed is seen once.
enum class View : std::uint8_t { kFirst, kSecond, kOnlyOne };

// A line each; none where nothing is seen twice.
std::optional<std::vector<View>> views_of_lines(const SweepReadings& readings);

}  // namespace swivel
