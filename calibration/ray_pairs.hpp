// Rays that look up, or down, to both sides of the axis at one angle. docs/geometry.md (21).
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "calibration/sweep_readings.hpp"

namespace swivel {

// Two rays of one line, at angles from the axis that are opposite to within a beam step.
struct RayPair {
  std::size_t line;
  double axis_angle_rad;
  double first_rad, second_rad;
  double first_m, second_m;

  double height_m() const {
    return 0.5 * (first_m * std::cos(first_rad) + second_m * std::cos(second_rad));
  }
};
using RayPairs = std::vector<RayPair>;

// centreline_rad: added to a beam's angle it is that from the axis.
RayPairs pairs_of(const SweepReadings& readings, double centreline_rad);

// Those at the commonest height above, and at that below: roof and floor, where they are large
// enough.
RayPairs on_roof_or_floor(const RayPairs& pairs);

}  // namespace swivel
