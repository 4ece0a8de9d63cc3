// The bias of the lidar's centreline, from a roof or a floor alone: rays that are symmetric about
// the axis meet it at the same height. Zeng 2018, algorithm 1; docs/geometry.md (21).
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "calibration/rig.hpp"
#include "calibration/sweep_readings.hpp"

namespace swivel {

struct SymmetricRaysFit {
  // Of the centreline, with the roll of the mounting in it; NaN where there is no such surface.
  double bias_rad = std::numeric_limits<double>::quiet_NaN();
  double sigma_rad = std::numeric_limits<double>::quiet_NaN();
  double lean_rad = 0.0;  // of the surface out of square to the axis, where it was needed
  bool verified = false;  // the second half of the sweep agrees
  double second_half_off_rad = std::numeric_limits<double>::quiet_NaN();
  std::size_t pairs = 0;
  int attempts = 0;
  std::string reason;  // why there is none, or why it is not verified
};

// Takes rigs whose centreline lies along the axis, up or down.
SymmetricRaysFit fit_symmetric_rays(const SweepReadings& readings, const RigGeometry& nominal);

}  // namespace swivel
