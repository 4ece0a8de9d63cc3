// The plate's azimuth by maximum likelihood: each beam near the plate's outline says hit or miss,
// and the outline is laid where all of them are likeliest. docs/geometry.md (14) to (18).
//
// It needs no ring: a beam's range only says which of the two it is, and its direction, which is
// exact, where. Height, tilt and the look of the edges are fitted along, held by what is known of
// them (PlateShape): the tilt above all shifts the azimuth.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/plate_beams.hpp"
#include "calibration/rig.hpp"

namespace swivel {

// Height, roll, pitch, growth and log softness of a PlateShape.
using ShapeVector = Eigen::Matrix<double, 5, 1>;
using ShapeMatrix = Eigen::Matrix<double, 5, 5>;

struct PlateFit {
  double beta_rad = 0.0;
  double beta_sigma_rad = 0.0;  // what the unknown shape leaves included
  PlateShape shape;             // as this sweep shows it, what was known before included
  ShapeMatrix shape_information = ShapeMatrix::Zero();  // inverse of the shape's covariance
  ShapeVector beta_by_shape = ShapeVector::Zero();  // by how much beta goes along with the shape
  double residual_m = 0.0;     // rms distance from the plate of what was measured on it
  std::size_t hits = 0;        // beams that are on the plate rather than not
  std::size_t edge_beams = 0;  // beams that the azimuth was found from
  double misfit = 0.0;         // mean of squares of the edges' residuals; 1 when the model holds
};

// `beta_rad` within some degrees of the truth, from judge_plate. None if the fit finds no rest.
std::optional<PlateFit> fit_plate(const std::vector<PlateBeam>& beams, const PlateGeometry& plate,
                                  double beta_rad);

}  // namespace swivel
