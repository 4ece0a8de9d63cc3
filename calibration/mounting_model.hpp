// What of a mounting can be estimated, and how the beams move with it. docs/geometry.md (19), (20).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "calibration/rig.hpp"
#include "calibration/sweep_readings.hpp"

namespace swivel {

// Four values of the mounting (19), and two of lidar and axis that would be taken for it.
enum MountingValue {
  kMountingBias,    // of the centreline; the roll about the scan plane's normal is in it
  kMountingTilt,    // ry: of the scan plane out of the axis
  kMountingLeverX,  // tx, ty: of the lidar's centre from the axis
  kMountingLeverY,
  kAxisHysteresis,  // added to the axis angle in sweeps in which it falls
  kRangeOffset,     // the lidar says this too much
};
inline constexpr int kMountingValues = 6;
using MountingVector = Eigen::Matrix<double, kMountingValues, 1>;
using MountingMatrix = Eigen::Matrix<double, kMountingValues, kMountingValues>;

// As the rig file or a calibration has it; no offset of ranges.
MountingVector mounting_of(const RigGeometry& rig);

// The rig with that mounting. Roll, yaw and shift along the axis, which no sweep shows (19), stay
// as they are.
RigGeometry with_mounting(const RigGeometry& rig, const MountingVector& mounting);

// The turn of the shaft by an axis angle: between the frame that turns and that which is at rest.
class ShaftTurn {
 public:
  explicit ShaftTurn(double angle_rad) : cosine_(std::cos(angle_rad)), sine_(std::sin(angle_rad)) {}

  Eigen::Vector3d to_rest(const Eigen::Vector3d& v) const {
    return {cosine_ * v.x() - sine_ * v.y(), sine_ * v.x() + cosine_ * v.y(), v.z()};
  }
  Eigen::Vector3d to_turning(const Eigen::Vector3d& v) const {
    return {cosine_ * v.x() + sine_ * v.y(), cosine_ * v.y() - sine_ * v.x(), v.z()};
  }

 private:
  double cosine_;
  double sine_;
};

// The beams of a sweep under a mounting, in the frame that turns with the shaft.
class MountedBeams {
 public:
  MountedBeams(const RigGeometry& rig, const MountingVector& mounting,
               const SweepReadings& readings);

  // At the instant of beam `beam` of a line, hysteresis counted.
  ShaftTurn shaft_at(const LineOfReadings& line, std::size_t beam) const;

  const Eigen::Vector3d& direction(std::size_t beam) const { return directions_[beam]; }
  const Eigen::Vector3d& lever_arm_m() const { return lever_arm_m_; }
  double range_offset_m() const { return range_offset_m_; }

  // At the range that the lidar said.
  Eigen::Vector3d turning_point(std::size_t beam, double range_m) const {
    return lever_arm_m_ + (range_m - range_offset_m_) * directions_[beam];
  }

  // How far that point moves along a normal, given in the turning frame, with each value.
  MountingVector moves_along(const Eigen::Vector3d& normal, const LineOfReadings& line,
                             std::size_t beam, double range_m) const;

 private:
  Eigen::Vector3d lever_arm_m_;
  double hysteresis_rad_;
  double range_offset_m_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<Eigen::Vector3d> by_bias_;  // their derivatives
  std::vector<Eigen::Vector3d> by_tilt_;
};

}  // namespace swivel
