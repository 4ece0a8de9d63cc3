// Sweeps of the bench's world, with a shaft that need not turn as far as it was told.
#pragma once

#include <cstdint>

#include "calibration/organised_cloud.hpp"
#include "hardware/sim/lidar.hpp"

namespace swivel {

struct SimulatedSweep {
  int mode = 1;
  double start_deg = 0.0;    // of the shaft
  double further_deg = 0.0;  // than it was told; negative: steps lost
  double at_share = 0.5;     // of the sweep: where that happened, at once
  sim::WorldOptions world;
  sim::LidarOptions lidar;
  std::uint64_t seed = 1;
};

// The raw cloud as if the shaft had turned as told. Only the lines that a seam needs are cast:
// a quarter of the sweep at either end.
OrganisedCloud raw_cloud(const SimulatedSweep& sweep);

}  // namespace swivel
