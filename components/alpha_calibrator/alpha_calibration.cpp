#include "components/alpha_calibrator/alpha_calibration.hpp"

#include <fmt/core.h>

#include "components/common/calibration_file.hpp"
#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

// The four walls of the room and some large upright furniture; the fit tells them apart.
constexpr std::size_t kWallsLookedFor = 8;

}  // namespace

AlphaCalibration::AlphaCalibration(const RigFile& rig, double room_yaw_deg) : rig_(rig.rig) {
  if (!rig.plate) {
    throw ConfigurationError(rig.path + ": has no 'plate', so there is no alpha to calibrate");
  }
  options_.initial_alpha_rad = rig.plate->alpha_rad;
  options_.room_yaw_rad = rad_from_deg(room_yaw_deg);
}

AlphaCalibration::Added AlphaCalibration::add(const msg::Attitude& attitude,
                                              const OrganisedCloud& cloud) {
  if (attitude.verdict() != msg::VERDICT_GOOD) {
    return {false, "the plate was not found: " + attitude.reason()};
  }
  if (attitude.lines_missing() > 0) {
    return {false, std::to_string(attitude.lines_missing()) + " lines are missing"};
  }
  AlphaSweep sweep;
  sweep.beta_rad = rad_from_deg(attitude.beta_deg());
  sweep.beta_sigma_rad = rad_from_deg(attitude.beta_sigma_deg());
  sweep.walls = find_walls(cloud, kWallsLookedFor);
  const std::size_t walls = sweep.walls.size();
  if (sweeps_.empty()) {
    mode_ = attitude.mode();
    estimator_ = attitude.estimator();
  }
  sweeps_.push_back(std::move(sweep));
  return {true, fmt::format("beta {:.3f} +- {:.3f} deg, {} upright planes", attitude.beta_deg(),
                            attitude.beta_sigma_deg(), walls)};
}

AlphaCalibration::Outcome AlphaCalibration::fit(const LidarName& lidar,
                                                std::int64_t time_ns) const {
  const AlphaResult result = fit_alpha(sweeps_, options_);
  if (!result.fit) return {std::nullopt, result.reason};
  const AlphaFit& fit = *result.fit;
  return {to_message(fit, lidar, time_ns),
          fmt::format("alpha {:.4f} +- {:.4f} deg from {} sweeps of mode {}",
                      deg_from_rad(fit.alpha_rad), deg_from_rad(fit.sigma_rad), fit.sweeps_used,
                      mode_)};
}

msg::Calibration AlphaCalibration::to_message(const AlphaFit& fit, const LidarName& lidar,
                                              std::int64_t time_ns) const {
  const double sigma_deg = deg_from_rad(fit.sigma_rad);
  msg::Calibration calibration;
  calibration.rig(rig_);
  calibration.time_ns(time_ns);
  calibration.alpha_deg(deg_from_rad(fit.alpha_rad));
  calibration.covariance()[kAlpha * kCalibrationSize + kAlpha] = sigma_deg * sigma_deg;
  calibration.residual_deg(deg_from_rad(fit.residual_rms_rad));
  calibration.sweeps_used(static_cast<std::uint32_t>(fit.sweeps_used));
  calibration.mode(static_cast<std::uint8_t>(mode_));
  calibration.serial_number(lidar.serial_number);
  calibration.firmware(lidar.firmware);
  calibration.provenance(fmt::format("four walls, estimator {}, {} sweeps of mode {}", estimator_,
                                     fit.sweeps_used, mode_));
  return calibration;
}

}  // namespace swivel
