#include "calibration/line_assembly.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr auto kMetresPerMillimetre = static_cast<float>(m_from_mm(1.0));
constexpr double kLongestRangeM = 65.535;
constexpr double kAllowedShiftM = 1e-7;

Eigen::Matrix3d rotation_z(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Invalid is NaN, which the arithmetic then carries to x, y and z: a loop without a branch.
void read_ranges(const LineReadings& readings, std::size_t count, float* ranges_m) {
  const std::uint16_t* const ranges_mm = readings.ranges_mm.data();
  const float min_mm = readings.range_min_mm;
  const float max_mm = readings.range_max_mm;
  for (std::size_t beam = 0; beam < count; ++beam) {
    const float range_mm = ranges_mm[beam];
    const float not_too_near_mm = range_mm < min_mm ? kNaN : range_mm;
    ranges_m[beam] = (range_mm > max_mm ? kNaN : not_too_near_mm) * kMetresPerMillimetre;
  }
}

}  // namespace

LineAssembler::LineAssembler(const ForwardModel& model)
    : model_(model),
      tolerance_rad_(kAllowedShiftM / (kLongestRangeM * static_cast<double>(model.beam_count()))),
      angle_per_beam_rad_(std::numeric_limits<double>::quiet_NaN()),
      directions_(3, model.beam_count()),
      lever_arms_m_(3, model.beam_count()),
      ranges_m_(model.beam_count()),
      intensities_(model.beam_count()) {}

void LineAssembler::assemble(const LineReadings& readings, double axis_angle_rad,
                             double angle_per_beam_rad, CloudPoint* row) {
  if (!(std::abs(angle_per_beam_rad - angle_per_beam_rad_) <= tolerance_rad_)) {
    turn_beams(angle_per_beam_rad);
  }
  read_line(readings);
  project(model_.rig().T_base_axis.linear() * rotation_z(axis_angle_rad), row);
}

void LineAssembler::assemble(const LineReadings& readings,
                             const std::vector<double>& axis_angles_rad, CloudPoint* row) {
  assert(axis_angles_rad.size() == model_.beam_count());
  read_line(readings);
  for (std::size_t beam = 0; beam < model_.beam_count(); ++beam) {
    const Eigen::Vector3f point =
        model_.point(beam, static_cast<double>(ranges_m_[beam]), axis_angles_rad[beam])
            .cast<float>();
    row[beam] = {point.x(), point.y(), point.z(), intensities_[beam]};
  }
}

void LineAssembler::turn_beams(double angle_per_beam_rad) {
  const Eigen::Isometry3d& T_axis_lidar = model_.rig().T_axis_lidar;
  for (Eigen::Index beam = 0; beam < directions_.cols(); ++beam) {
    const Eigen::Matrix3d turn = rotation_z(static_cast<double>(beam) * angle_per_beam_rad);
    const double beam_angle_rad = model_.beam_angle_rad(static_cast<std::size_t>(beam));
    directions_.col(beam) =
        (turn * T_axis_lidar.linear() * beam_direction_in_lidar(beam_angle_rad)).cast<float>();
    lever_arms_m_.col(beam) = (turn * T_axis_lidar.translation()).cast<float>();
  }
  angle_per_beam_rad_ = angle_per_beam_rad;
}

// A beam for which the readings say nothing is invalid like any other.
void LineAssembler::read_line(const LineReadings& readings) {
  assert(readings.ranges_mm.size() == model_.beam_count());
  const std::size_t said = std::min(readings.ranges_mm.size(), ranges_m_.size());
  read_ranges(readings, said, ranges_m_.data());
  std::fill(ranges_m_.begin() + static_cast<std::ptrdiff_t>(said), ranges_m_.end(), kNaN);
  const std::size_t bright = std::min(readings.intensities.size(), intensities_.size());
  std::copy_n(readings.intensities.begin(), bright, intensities_.begin());
  std::fill(intensities_.begin() + static_cast<std::ptrdiff_t>(bright), intensities_.end(), 0.0F);
}

// R (r d + l) + o in floats: the compiler takes four beams at a time.
void LineAssembler::project(const Eigen::Matrix3d& R_base_turned, CloudPoint* row) const {
  const Eigen::Matrix3f R = R_base_turned.cast<float>();
  const Eigen::Vector3f origin_m = model_.rig().T_base_axis.translation().cast<float>();
  const Eigen::Index beams = directions_.cols();
  for (Eigen::Index beam = 0; beam < beams; ++beam) {
    const float range_m = ranges_m_[static_cast<std::size_t>(beam)];
    const float x = range_m * directions_(0, beam) + lever_arms_m_(0, beam);
    const float y = range_m * directions_(1, beam) + lever_arms_m_(1, beam);
    const float z = range_m * directions_(2, beam) + lever_arms_m_(2, beam);
    row[beam] = {R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + origin_m.x(),
                 R(1, 0) * x + R(1, 1) * y + R(1, 2) * z + origin_m.y(),
                 R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + origin_m.z(),
                 intensities_[static_cast<std::size_t>(beam)]};
  }
}

}  // namespace swivel
