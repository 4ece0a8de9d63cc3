// Which beams tell where the plate's edges are, and what their ranges say: plate or not.
// docs/geometry.md (15).
#pragma once

#include <vector>

#include "calibration/plate_model.hpp"

namespace swivel {

// How far the ranges are off the plate where it surely is: their median, and the rms about it.
struct PlateRanges {
  double offset_m = 0.0;
  double rms_m = 0.0;
  std::size_t hits = 0;
};

// Here and below, every `stride`th beam counts.
PlateRanges ranges_on_plate(const std::vector<PlateBeam>& beams, std::size_t stride,
                            const PlateTriangle& triangle, const PlateFrame& frame);

// The beams near one edge alone, as near as its softness reaches and at least `least_zone_m`.
// What their ranges say is learned from all the others.
std::vector<EdgeBeam> edge_beams(const std::vector<PlateBeam>& beams, std::size_t stride,
                                 const PlateTriangle& triangle, const PlateParameters& parameters,
                                 double offset_m, double least_zone_m);

}  // namespace swivel
