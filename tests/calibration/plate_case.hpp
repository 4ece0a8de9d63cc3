// Recordings of the plate rig with their truth, in the format that tests/data/README.md gives.
#pragma once

#include <string>
#include <vector>

#include "calibration/organised_cloud.hpp"

namespace swivel {

struct PlateSweep {
  int mode = 0;
  OrganisedCloud cloud;         // frame O'
  double phi_offset_rad = 0.0;  // truth: of line 0
};

struct PlateCase {
  double alpha_rad = 0.0;  // truth
  std::vector<PlateSweep> sweeps;
};

// Throws std::runtime_error when a file is missing or too short.
PlateCase load_plate_case(const std::string& folder);

}  // namespace swivel
