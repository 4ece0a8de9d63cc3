#include "components/alpha_calibrator/alpha_calibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/common/calibration_file.hpp"
#include "components/common/listed.hpp"
#include "components/common/plate_shape_message.hpp"
#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

// The four walls of the room and some large upright furniture; the fit tells them apart.
constexpr std::size_t kWallsLookedFor = 8;

std::string walls_in_words(const AlphaFit& fit) {
  std::string words = "walls off square:";
  for (std::size_t wall = 0; wall < kWalls; ++wall) {
    if (std::isnan(fit.wall_angles_rad[wall])) continue;
    words += fmt::format(" {} {:+.3f}", kWallNames[wall], deg_from_rad(fit.wall_angles_rad[wall]));
  }
  return words + " deg";
}

std::string test_in_words(const AlphaFit& fit) {
  if (fit.degrees_of_freedom == 0) return "nothing to test it by";
  return fmt::format("chi-square {:.1f} of {} degrees of freedom", fit.chi_square,
                     fit.degrees_of_freedom);
}

std::string fit_in_words(const AlphaFit& fit, const std::string& origin) {
  std::string words =
      fmt::format("alpha {:.4f} +- {:.4f} deg from {} (sweeps {:.4f}, walls {:.4f}); {}; {}",
                  deg_from_rad(fit.alpha_rad), deg_from_rad(fit.sigma_rad), origin,
                  deg_from_rad(fit.sweeps_sigma_rad), deg_from_rad(fit.walls_sigma_rad),
                  walls_in_words(fit), test_in_words(fit));
  for (const std::string& remark : fit.remarks) words += "; " + remark;
  return words;
}

}  // namespace

std::string more_sweeps_in_words(const AlphaFit& fit, double sigma_deg) {
  const auto more = more_sweeps_for(fit, rad_from_deg(sigma_deg));
  if (!more) {
    return fmt::format(
        "more sweeps will not bring a sigma of {} deg: the walls, not square or too "
        "few, leave {:.4f}",
        sigma_deg, deg_from_rad(fit.walls_sigma_rad));
  }
  if (*more == 0) return fmt::format("no more sweeps needed for a sigma of {} deg", sigma_deg);
  return fmt::format("{} more such sweeps needed for a sigma of {} deg", *more, sigma_deg);
}

AlphaCalibration::AlphaCalibration(const RigFile& rig, const AlphaWishes& wishes)
    : rig_(rig.rig), wanted_sigma_deg_(wishes.sigma_deg) {
  if (!rig.plate) {
    throw ConfigurationError(rig.path + ": has no 'plate', so there is no alpha to calibrate");
  }
  drawn_ = *rig.plate;
  estimate_ = attitude_estimator(rig.estimator, rig.geometry);
  options_.initial_alpha_rad = rig.plate->alpha_rad;
  options_.room_yaw_rad = rad_from_deg(wishes.room_yaw_deg);
  options_.least_sweeps = wishes.least_sweeps;
}

AlphaCalibration::Added AlphaCalibration::add(const msg::Attitude& attitude,
                                              const OrganisedCloud& cloud,
                                              const std::string& name) {
  if (attitude.verdict() != msg::VERDICT_GOOD) {
    return {false, "its plate is not to be trusted: " + attitude.reason()};
  }
  if (attitude.lines_missing() > 0) {
    return {false, std::to_string(attitude.lines_missing()) + " lines are missing"};
  }
  AlphaSweep sweep;
  sweep.beta_rad = rad_from_deg(attitude.beta_deg());
  sweep.beta_sigma_rad = rad_from_deg(attitude.beta_sigma_deg());
  sweep.walls = find_walls(cloud, kWallsLookedFor);
  sweep.name = name.empty() ? std::to_string(attitude.sweep_id()) : name;
  const std::size_t walls = sweep.walls.size();
  // The attitude may rest on the calibration before this one; the plate is learned anew.
  if (estimate_) {
    if (const auto fit = (*estimate_)(cloud, drawn_).fit) fits_.push_back(*fit);
  }
  modes_.insert(attitude.mode());
  estimator_ = attitude.estimator();
  sweeps_.push_back(std::move(sweep));
  return {true, fmt::format("beta {:.3f} +- {:.3f} deg, {} upright planes", attitude.beta_deg(),
                            attitude.beta_sigma_deg(), walls)};
}

AlphaCalibration::Outcome AlphaCalibration::fit(const LidarName& lidar,
                                                std::int64_t time_ns) const {
  const bool learned = !fits_.empty() && fits_.size() == sweeps_.size();
  const LearnedPlate plate = learned ? learn_plate(fits_, drawn_.shape) : LearnedPlate();
  const AlphaResult result = fit_alpha(learned ? with_learned_betas(plate) : sweeps_, options_);
  if (!result.fit) return {std::nullopt, result.reason};
  std::string words = fit_in_words(*result.fit, origin_in_words(*result.fit));
  if (wanted_sigma_deg_) words += "; " + more_sweeps_in_words(*result.fit, *wanted_sigma_deg_);
  Outcome outcome{to_message(*result.fit, lidar, time_ns), words};
  if (learned) swivel::to_message(plate, *outcome.calibration);
  return outcome;
}

std::vector<AlphaSweep> AlphaCalibration::with_learned_betas(const LearnedPlate& plate) const {
  std::vector<AlphaSweep> sweeps = sweeps_;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    sweeps[sweep].beta_rad = plate.betas_rad[sweep].value;
    sweeps[sweep].beta_sigma_rad = plate.betas_rad[sweep].sigma;
  }
  return sweeps;
}

std::string AlphaCalibration::origin_in_words(const AlphaFit& fit) const {
  return fmt::format("{} sweep{} of mode{} {}", fit.sweeps_used, fit.sweeps_used == 1 ? "" : "s",
                     modes_.size() == 1 ? "" : "s", listed(modes_));
}

msg::Calibration AlphaCalibration::to_message(const AlphaFit& fit, const LidarName& lidar,
                                              std::int64_t time_ns) const {
  const double sigma_deg = deg_from_rad(fit.sigma_rad);
  const auto walls = std::count_if(fit.wall_angles_rad.begin(), fit.wall_angles_rad.end(),
                                   [](double angle_rad) { return !std::isnan(angle_rad); });
  msg::Calibration calibration;
  calibration.rig(rig_);
  calibration.time_ns(time_ns);
  calibration.alpha_deg(deg_from_rad(fit.alpha_rad));
  calibration.covariance()[kAlpha * kCalibrationSize + kAlpha] = sigma_deg * sigma_deg;
  calibration.residual_deg(deg_from_rad(fit.residual_rms_rad));
  calibration.chi_square(fit.chi_square);
  calibration.degrees_of_freedom(static_cast<std::uint32_t>(fit.degrees_of_freedom));
  calibration.sweeps_used(static_cast<std::uint32_t>(fit.sweeps_used));
  calibration.mode(static_cast<std::uint8_t>(modes_.size() == 1 ? *modes_.begin() : 0));
  calibration.serial_number(lidar.serial_number);
  calibration.firmware(lidar.firmware);
  calibration.provenance(
      fmt::format("{} walls, estimator {}, {}", walls, estimator_, origin_in_words(fit)));
  return calibration;
}

}  // namespace swivel
