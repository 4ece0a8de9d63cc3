// What the sweeps together say of the walls' angles, and how well they agree. docs/geometry.md (9),
// (11).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/alpha.hpp"
#include "calibration/chi_square.hpp"
#include "calibration/room_walls.hpp"

namespace swivel {

// One wall in one sweep: by how much it is off its place if the plate stood as drawn.
struct WallSighting {
  std::size_t wall;  // index into RoomWalls::walls
  double error_rad;
  double variance;  // of its normal; what beta adds is common to the sweep
};

struct SweepView {
  std::string name;
  double beta_variance;
  std::vector<WallSighting> sightings;
};
using Views = std::vector<SweepView>;

// The walls' own angles in the plate's frame, by generalised least squares.
struct WallAngles {
  Eigen::VectorXd error_rad;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd normal_variance;  // the part of it that is each wall's own
};

std::string name_of(const AlphaSweep& sweep, std::size_t index);

Views views_of(const std::vector<AlphaSweep>& sweeps, const RoomWalls& room,
               const AlphaOptions& options);

// Takes out what saw no wall, and says which that were; empty: none.
std::string leave_out_blind(Views& views);

// Takes out, with a remark, each wall of a sweep that is unlike what the others saw there.
WallAngles fit_wall_angles(const RoomWalls& room, Views& views, std::vector<std::string>& remarks);

std::string why_sweeps_disagree(const Views& views, const WallAngles& angles,
                                const AlphaOptions& options);

// Eq. (11): of the sweeps about the fit, by their betas.
ChiSquare scatter_of_sweeps(const Views& views, const WallAngles& angles);

// Of the walls within each sweep, by their normals.
ChiSquare scatter_of_walls(const Views& views, const WallAngles& angles);

// Where the walls scatter by more than their normals' sigmas, these are too small.
WallAngles widen_normals(double times, const RoomWalls& room, Views& views);

}  // namespace swivel
