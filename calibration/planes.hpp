// Planes in a cloud, and the walls among them. docs/geometry.md (8).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "calibration/organised_cloud.hpp"
#include "calibration/units.hpp"

namespace swivel {

// The points p with normal . p = -distance.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, towards the origin: the rig
  double distance_m = 0.0;                            // of the origin from the plane, >= 0
  double rms_m = 0.0;                                 // thickness: sd of its points' distances
  std::size_t points = 0;                             // within three times that
  double length_m = 0.0;  // how far it reaches, level and up, were its points spread evenly
  double height_m = 0.0;
  // Of the normal's azimuth about Z, from the points' noise alone: a wall that is not flat or
  // not square is wrong by more.
  double azimuth_sigma_rad = 0.0;

  double azimuth_rad() const { return std::atan2(normal.y(), normal.x()); }
};

struct PlaneOptions {
  double lever_arm_m = 0.0;                   // of the lidar: it looks from so near to the origin
  double band_m = 0.05;                       // half the thickness in which a plane is looked for
  double shared_strip_m = 0.1;                // about another plane, whose points could be either's
  double least_share = 0.02;                  // of the cloud's points; what has less is no plane
  std::size_t sampled = 15'000;               // points in which planes are looked for
  double wall_tilt_rad = rad_from_deg(10.0);  // how far a wall may lean
};

// The `count` largest planes of any direction, largest first; fewer when there are no more.
std::vector<Plane> find_planes(const OrganisedCloud& cloud, std::size_t count,
                               const PlaneOptions& options = {});

// The upright ones only: neither floor nor roof, but any large piece of furniture too.
std::vector<Plane> find_walls(const OrganisedCloud& cloud, std::size_t count,
                              const PlaneOptions& options = {});

}  // namespace swivel
