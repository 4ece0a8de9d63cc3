#include "components/common/calibration_use.hpp"

#include <algorithm>
#include <cmath>

#include "components/common/calibration_file.hpp"

namespace swivel {
namespace {

double variance(const msg::Calibration& calibration, std::size_t index) {
  return calibration.covariance()[index * kCalibrationSize + index];
}

bool all_finite(const msg::Calibration& calibration) {
  const auto finite = [](double value) { return std::isfinite(value); };
  const auto& xyz_mm = calibration.mounting_xyz_mm();
  const auto& rpy_deg = calibration.mounting_rpy_deg();
  const auto& covariance = calibration.covariance();
  return finite(calibration.alpha_deg()) && finite(calibration.bias_deg()) &&
         finite(calibration.hysteresis_deg()) && finite(calibration.hysteresis_sigma_deg()) &&
         std::all_of(xyz_mm.begin(), xyz_mm.end(), finite) &&
         std::all_of(rpy_deg.begin(), rpy_deg.end(), finite) &&
         std::all_of(covariance.begin(), covariance.end(), finite);
}

bool variances_are(const msg::Calibration& calibration) {
  for (std::size_t index = 0; index < kCalibrationSize; ++index) {
    if (variance(calibration, index) < 0.0) return false;
  }
  return true;
}

void copy_mounting(const msg::Calibration& from, msg::Calibration& to) {
  to.bias_deg(from.bias_deg());
  to.mounting_xyz_mm(from.mounting_xyz_mm());
  to.mounting_rpy_deg(from.mounting_rpy_deg());
  to.hysteresis_deg(from.hysteresis_deg());
  to.hysteresis_sigma_deg(from.hysteresis_sigma_deg());
  for (std::size_t row = kBias; row < kCalibrationSize; ++row) {
    for (std::size_t column = kBias; column < kCalibrationSize; ++column) {
      const std::size_t at = row * kCalibrationSize + column;
      to.covariance()[at] = from.covariance()[at];
    }
  }
}

}  // namespace

bool tells_mounting(const msg::Calibration& calibration) {
  for (std::size_t index = kBias; index < kCalibrationSize; ++index) {
    if (variance(calibration, index) > 0.0) return true;
  }
  return false;
}

bool tells_alpha(const msg::Calibration& calibration) {
  return variance(calibration, kAlpha) > 0.0 || !tells_mounting(calibration);
}

RigGeometry calibrated_geometry(const RigGeometry& drawn, const msg::Calibration& calibration) {
  if (!tells_mounting(calibration)) return drawn;
  RigGeometry geometry = drawn;
  geometry.T_axis_lidar =
      transform_of(calibration.mounting_xyz_mm(), calibration.mounting_rpy_deg());
  geometry.bias_rad = rad_from_deg(calibration.bias_deg());
  geometry.hysteresis_rad = rad_from_deg(calibration.hysteresis_deg());
  return geometry;
}

void set_mounting(const RigGeometry& geometry, msg::Calibration& calibration) {
  const Eigen::Vector3d& xyz_m = geometry.T_axis_lidar.translation();
  const Eigen::Vector3d rpy_deg = rpy_deg_of(geometry.T_axis_lidar.linear());
  for (Eigen::Index i = 0; i < 3; ++i) {
    calibration.mounting_xyz_mm()[static_cast<std::size_t>(i)] = mm_from_m(xyz_m[i]);
    calibration.mounting_rpy_deg()[static_cast<std::size_t>(i)] = rpy_deg[i];
  }
  calibration.bias_deg(deg_from_rad(geometry.bias_rad));
  calibration.hysteresis_deg(deg_from_rad(geometry.hysteresis_rad));
}

msg::Calibration completed(const msg::Calibration& found,
                           const std::optional<msg::Calibration>& before) {
  msg::Calibration whole = found;
  const bool keeps = before && tells_mounting(*before) && !tells_mounting(found);
  if (!keeps || before->serial_number() != found.serial_number()) return whole;
  copy_mounting(*before, whole);
  whole.provenance(found.provenance() + "; mounting: " + before->provenance());
  return whole;
}

std::string CalibrationInUse::take(const msg::Calibration& calibration) {
  const std::string wrong = why_not(calibration);
  if (!wrong.empty()) return wrong;
  now_ = last_ = calibration;
  return {};
}

std::string CalibrationInUse::name_lidar(const std::string& serial_number) {
  if (serial_number == serial_number_) return {};
  serial_number_ = serial_number;
  now_ = last_;
  if (!last_) return {};
  const std::string wrong = why_not(*last_);
  if (!wrong.empty()) now_.reset();
  return wrong;
}

std::string CalibrationInUse::why_not(const msg::Calibration& calibration) const {
  const std::string rig = calibration.rig().to_string();
  const std::string& serial_number = calibration.serial_number();
  if (!rig.empty() && rig != rig_) return "it is of rig '" + rig + "', not of '" + rig_ + "'";
  const bool both_known = !serial_number.empty() && !serial_number_.empty();
  if (both_known && serial_number != serial_number_) {
    return "it is of the lidar " + serial_number + ", and " + serial_number_ +
           " scans; calibrate again";
  }
  if (!all_finite(calibration) || !variances_are(calibration)) {
    return "a value or a variance in it is not a number; calibrate again";
  }
  return {};
}

std::optional<std::string> lidar_serial_number(const msg::Health& health) {
  if (health.participant().to_string() != "hokuyo_reader") return std::nullopt;
  for (const msg::Fact& fact : health.facts()) {
    if (fact.name().to_string() == "serial_number") return fact.value();
  }
  return std::nullopt;
}

}  // namespace swivel
