// Which rays of a sweep meet which plane of the room, and what they say of mounting and planes.
// docs/geometry.md (23).
#pragma once

#include <cstddef>
#include <vector>

#include "calibration/half_scans.hpp"
#include "calibration/line_sighter.hpp"
#include "calibration/mounting_equations.hpp"

namespace swivel {

// One plane's part of the normal equations: mounting first, then two turns of the normal and the
// distance.
inline constexpr int kPlaneValues = 3;
using PlaneVector = Eigen::Matrix<double, kMountingValues + kPlaneValues, 1>;
using PlaneMatrix =
    Eigen::Matrix<double, kMountingValues + kPlaneValues, kMountingValues + kPlaneValues>;

struct PlaneSums {
  PlaneMatrix information = PlaneMatrix::Zero();
  PlaneVector gradient = PlaneVector::Zero();
  double squares = 0.0;  // of residuals over sigma
  std::size_t rays = 0;
  std::vector<PlaneVector> by_sector;  // lines that are near in time err together
};

struct PlaneSightings {
  std::vector<PlaneSums> planes;
  RayMask explained;  // rays that stand on a plane, or where two could be meant
};

PlaneSightings sight_planes(const SweepReadings& readings, const MountedBeams& beams,
                            const std::vector<SightedPlane>& planes);

// The mounting's equations, with every plane free to move as its rays ask for.
MountingEquations without_planes(const PlaneSightings& sightings);

// The planes, moved as their rays ask for after the mounting has moved by that much.
std::vector<SightedPlane> moved_planes(const std::vector<SightedPlane>& planes,
                                       const PlaneSightings& sightings,
                                       const MountingVector& mounting_moved);

}  // namespace swivel
