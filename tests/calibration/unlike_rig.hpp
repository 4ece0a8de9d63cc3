// A rig in which no two numbers are alike and none is zero, so that a mistake in a sign, an
// order or a frame shows.
#pragma once

#include "calibration/rig.hpp"

namespace swivel {

inline Eigen::Isometry3d unlike_transform(double x_m, double y_m, double z_m, double roll_deg,
                                          double pitch_deg, double yaw_deg) {
  return Eigen::Translation3d(x_m, y_m, z_m) *
         Eigen::AngleAxisd(rad_from_deg(yaw_deg), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rad_from_deg(pitch_deg), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rad_from_deg(roll_deg), Eigen::Vector3d::UnitX());
}

inline RigGeometry unlike_rig() {
  RigGeometry rig;
  rig.T_axis_lidar = unlike_transform(0.0139, -0.021, 0.034, 2.0, -5.0, 11.0);
  rig.T_base_axis = unlike_transform(0.31, 0.17, -0.23, 37.0, -90.0, 61.0);
  rig.bias_rad = rad_from_deg(1.7);
  rig.hysteresis_rad = rad_from_deg(0.23);
  return rig;
}

}  // namespace swivel
