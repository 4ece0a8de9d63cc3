#include "calibration/mounting_model.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/forward_model.hpp"

namespace swivel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

struct RollPitchYaw {
  double roll_rad;
  double pitch_rad;
  double yaw_rad;
};

RollPitchYaw angles_of(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Matrix3d rotation_of(const RollPitchYaw& angles) {
  return (AngleAxisd(angles.yaw_rad, Vector3d::UnitZ()) *
          AngleAxisd(angles.pitch_rad, Vector3d::UnitY()) *
          AngleAxisd(angles.roll_rad, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

MountingVector mounting_of(const RigGeometry& rig) {
  MountingVector mounting = MountingVector::Zero();
  mounting[kMountingBias] = rig.bias_rad;
  mounting[kMountingTilt] = angles_of(rig.T_axis_lidar.linear()).pitch_rad;
  mounting[kMountingLeverX] = rig.T_axis_lidar.translation().x();
  mounting[kMountingLeverY] = rig.T_axis_lidar.translation().y();
  mounting[kAxisHysteresis] = rig.hysteresis_rad;
  return mounting;
}

RigGeometry with_mounting(const RigGeometry& rig, const MountingVector& mounting) {
  RigGeometry mounted = rig;
  RollPitchYaw angles = angles_of(rig.T_axis_lidar.linear());
  angles.pitch_rad = mounting[kMountingTilt];
  mounted.bias_rad = mounting[kMountingBias];
  mounted.hysteresis_rad = mounting[kAxisHysteresis];
  mounted.T_axis_lidar.linear() = rotation_of(angles);
  mounted.T_axis_lidar.translation().head<2>() << mounting[kMountingLeverX],
      mounting[kMountingLeverY];
  return mounted;
}

MountedBeams::MountedBeams(const RigGeometry& rig, const MountingVector& mounting,
                           const SweepReadings& readings)
    : hysteresis_rad_(mounting[kAxisHysteresis]), range_offset_m_(mounting[kRangeOffset]) {
  const RigGeometry mounted = with_mounting(rig, mounting);
  const Eigen::Matrix3d R_axis_lidar = mounted.T_axis_lidar.linear();
  const double yaw_rad = angles_of(R_axis_lidar).yaw_rad;
  const Vector3d tilting_about(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  lever_arm_m_ = mounted.T_axis_lidar.translation();
  const ForwardModel model(mounted, readings.first_beam_angle_rad, readings.beam_step_rad,
                           readings.beams());
  for (std::size_t beam = 0; beam < readings.beams(); ++beam) {
    const double angle_rad = model.beam_angle_rad(beam);
    directions_.emplace_back(R_axis_lidar * beam_direction_in_lidar(angle_rad));
    by_bias_.emplace_back(R_axis_lidar * beam_direction_in_lidar(angle_rad + kPi / 2));
    by_tilt_.emplace_back(tilting_about.cross(directions_.back()));
  }
}

ShaftTurn MountedBeams::shaft_at(const LineOfReadings& line, std::size_t beam) const {
  return ShaftTurn(line.axis_angle_rad + static_cast<double>(beam) * line.angle_per_beam_rad +
                   (line.turning_down ? hysteresis_rad_ : 0.0));
}

MountingVector MountedBeams::moves_along(const Vector3d& normal, const LineOfReadings& line,
                                         std::size_t beam, double range_m) const {
  const double true_range_m = range_m - range_offset_m_;
  MountingVector moves;
  moves[kMountingBias] = true_range_m * normal.dot(by_bias_[beam]);
  moves[kMountingTilt] = true_range_m * normal.dot(by_tilt_[beam]);
  moves[kMountingLeverX] = normal.x();
  moves[kMountingLeverY] = normal.y();
  const Vector3d point = turning_point(beam, range_m);
  moves[kAxisHysteresis] =
      line.turning_down ? normal.y() * point.x() - normal.x() * point.y() : 0.0;
  moves[kRangeOffset] = -normal.dot(directions_[beam]);
  return moves;
}

}  // namespace swivel
