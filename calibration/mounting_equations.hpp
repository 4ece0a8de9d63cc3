// Least squares over a mounting of which the data show some directions and not others.
// docs/geometry.md (24), (25).
#pragma once

#include <vector>

#include "calibration/mounting_model.hpp"

namespace swivel {

// How far a mounting may be from what the rig file says, one sigma. A value of sigma 0 stays.
struct MountingPrior {
  MountingVector nominal = MountingVector::Zero();
  MountingVector sigma = MountingVector::Zero();
};
MountingPrior prior_of(const RigGeometry& nominal);

// Of residuals over their sigma: sums of J^T J and J^T e, and J^T e of those that err together.
struct MountingEquations {
  MountingMatrix information = MountingMatrix::Zero();
  MountingVector gradient = MountingVector::Zero();
  std::vector<MountingVector> groups;

  void add(const MountingEquations& more);
};

struct MountingSolution {
  MountingVector value = MountingVector::Zero();        // the nominal where nothing was seen
  MountingMatrix covariance = MountingMatrix::Zero();   // the prior's where nothing was seen
  MountingMatrix information = MountingMatrix::Zero();  // of what was seen
  MountingVector unseen = MountingVector::Zero();       // share of each value's variance, 0 to 1
  int seen_directions = 0;
};

// One step of Gauss and Newton from `value`, in the directions that the data show.
MountingSolution solve(const MountingEquations& equations, const MountingVector& value,
                       const MountingPrior& prior);

// Values of several sweeps, each weighed by its information: one step from the nominal.
MountingSolution solve_together(const std::vector<MountingSolution>& sweeps,
                                const MountingPrior& prior);

}  // namespace swivel
