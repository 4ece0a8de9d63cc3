// What a rig is, geometrically. Frames and equations: docs/geometry.md.
//   lidar   L: X normal to the scan plane, Z the centreline; beam theta points to
//           (0, sin theta, cos theta) (Yuan 2021, eq. 4)
//   axis    turns with the shaft; Z is the axis of rotation; at axis angle 0 it is at rest
//           against base
//   base    O: fixed to the rig, X to its front, Z up
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "calibration/units.hpp"

namespace swivel {

struct RigGeometry {
  // Maps the lidar frame into the turning frame of the axis. Yuan: a shift of 13.9 mm along X.
  Eigen::Isometry3d T_axis_lidar = Eigen::Isometry3d::Identity();
  // Maps the axis frame at angle 0 into the base. Yuan: identity.
  Eigen::Isometry3d T_base_axis = Eigen::Isometry3d::Identity();
  // Added to every beam's angle: the bias of the lidar's centreline (Zeng 2018).
  double bias_rad = 0.0;
  // Added to the axis angle in sweeps in which it falls: the play of the gear.
  double hysteresis_rad = 0.0;
};

// A value that is known this well: one standard deviation.
struct Known {
  double value = 0.0;
  double sigma = 0.0;
};

// What no drawing says of a plate, or says inexactly: how it stands, and how its edges look to a
// spot of light that is no point. The sigmas here are those of a plate that was never measured.
struct PlateShape {
  Known height_m{0.0, 0.0015};               // above the drawn depth
  Known roll_rad{0.0, rad_from_deg(2.0)};    // lifts its left side, seen from the axis
  Known pitch_rad{0.0, rad_from_deg(1.0)};   // lifts its tip
  Known growth_m{0.001, 0.002};              // of every edge, times what the slant adds
  Known log_softness{std::log(0.002), 0.7};  // of an edge in metres, one sd of its probit
  Known range_offset_m{0.0, 0.010};          // of ranges as short as these
};

// The triangular plate of Yuan 2021: an isosceles right triangle in a plane normal to the
// axis, its base edge nearest to the axis, its middle line pointing at azimuth alpha in O.
struct PlateGeometry {
  double base_distance_m = 0.05475;       // from the axis to the base edge
  double hypotenuse_m = 0.112;            // the base edge's length
  double depth_m = 0.060935;              // of the plate below the lidar's centre, along the axis
  double alpha_rad = rad_from_deg(30.0);  // as drawn; a calibration replaces it
  PlateShape shape;                       // likewise

  // The ring in which the plate's points are looked for (Yuan 2021, section 4.1).
  double ring_inner_m = 0.0625;
  double ring_outer_m = 0.1155;
  double ring_thickness_m = 0.020;
};

}  // namespace swivel
