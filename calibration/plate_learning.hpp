// What several sweeps together say of a plate: how it stands against its drawing, and how its edges
// look. With that known, each sweep's azimuth is sharper. docs/geometry.md (18).
#pragma once

#include <vector>

#include "calibration/plate_fit.hpp"

namespace swivel {

struct LearnedPlate {
  PlateShape shape;
  double residual_m = 0.0;       // rms distance from the plate of what was measured on it
  std::vector<Known> betas_rad;  // of each fit, with that shape
};

// `fits` were all made with what is known of `drawn`. Takes at least one.
LearnedPlate learn_plate(const std::vector<PlateFit>& fits, const PlateShape& drawn);

}  // namespace swivel
