// The one forward model: a beam, its range and the axis angle give a point in the base. The
// assembler runs it forward, the calibrators differentiate it.
//
//   p_base = T_base_axis * Rz(axis angle) * T_axis_lidar * r (0, sin theta, cos theta)
//
// docs/geometry.md (2); for Yuan's rig it is his equations 4 to 6.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "calibration/rig.hpp"

namespace swivel {

// Over any scalar, for automatic differentiation by mounting, bias and angle.
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 1> beam_direction_in_lidar(const Scalar& beam_angle_rad) {
  using std::cos;
  using std::sin;
  return {Scalar(0.0), sin(beam_angle_rad), cos(beam_angle_rad)};
}

template <typename Scalar>
Eigen::Matrix<Scalar, 3, 1> point_in_base(
    const Eigen::Transform<Scalar, 3, Eigen::Isometry>& T_base_axis, const Scalar& axis_angle_rad,
    const Eigen::Transform<Scalar, 3, Eigen::Isometry>& T_axis_lidar, const Scalar& beam_angle_rad,
    const Scalar& range_m) {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  const Vector3 p_lidar = range_m * beam_direction_in_lidar(beam_angle_rad);
  const Vector3 p_turning = T_axis_lidar * p_lidar;
  const Eigen::AngleAxis<Scalar> turn(axis_angle_rad, Vector3::UnitZ());
  return T_base_axis * (turn * p_turning);
}

class ForwardModel {
 public:
  ForwardModel(const RigGeometry& rig, double first_beam_angle_rad, double beam_step_rad,
               std::size_t beam_count);

  Eigen::Vector3d point(std::size_t beam, double range_m, double axis_angle_rad) const;

  // As the sensor numbers them, with the bias added.
  double beam_angle_rad(std::size_t beam) const;
  std::size_t beam_count() const { return beam_count_; }
  const RigGeometry& rig() const { return rig_; }

 private:
  RigGeometry rig_;
  double first_beam_angle_rad_;
  double beam_step_rad_;
  std::size_t beam_count_;
};

}  // namespace swivel
