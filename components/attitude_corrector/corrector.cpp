#include "components/attitude_corrector/corrector.hpp"

#include <cmath>
#include <limits>

#include "calibration/in_words.hpp"
#include "calibration/transform_cloud.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/plate_shape_message.hpp"
#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

msg::Verdict to_message(AttitudeVerdict verdict) {
  switch (verdict) {
    case AttitudeVerdict::kGood:
      return msg::VERDICT_GOOD;
    case AttitudeVerdict::kNoPlate:
      return msg::VERDICT_NO_PLATE;
    case AttitudeVerdict::kTooFewPoints:
      return msg::VERDICT_TOO_FEW_POINTS;
    case AttitudeVerdict::kForeignObject:
      return msg::VERDICT_FOREIGN_OBJECT;
    case AttitudeVerdict::kLinesMissing:
      return msg::VERDICT_LINES_MISSING;
  }
  return msg::VERDICT_NO_PLATE;
}

// Eqs (8) and (9), about the axis wherever it stands in the base.
Eigen::Isometry3d base_from_start(const RigGeometry& rig, double phi_offset_rad) {
  const Eigen::AngleAxisd turn(phi_offset_rad, Eigen::Vector3d::UnitZ());
  return rig.T_base_axis * turn * rig.T_base_axis.inverse();
}

msg::Attitude blank_attitude(const msg::Sweep& sweep) {
  msg::Attitude attitude;
  attitude.sweep_id(sweep.sweep_id());
  attitude.first_beam_time_ns(sweep.first_beam_time_ns());
  attitude.first_device_stamp_ms(sweep.first_device_stamp_ms());
  attitude.mode(sweep.mode());
  attitude.beta_deg(kUnknown);
  attitude.beta_sigma_deg(kUnknown);
  attitude.alpha_deg(kUnknown);
  attitude.phi_offset_deg(kUnknown);
  attitude.phi_offset_sigma_deg(kUnknown);
  attitude.residual_mm(kUnknown);
  attitude.seam_deg(kUnknown);
  attitude.seam_sigma_deg(kUnknown);
  attitude.lines_expected(sweep.lines_expected());
  attitude.lines_missing(sweep.lines_missing());
  return attitude;
}

}  // namespace

Corrector::Corrector(const RigFile& rig) : drawn_(rig), rig_(rig), calibration_(rig.rig) {
  if (rig.axis_measured) return;
  if (!rig.plate) {
    throw ConfigurationError(rig.path +
                             ": the axis is commanded, so the attitude is unknown: "
                             "give it a 'plate', or set axis.source to measured");
  }
  estimator_ = attitude_estimator(rig.estimator, rig.geometry);
  if (!estimator_) {
    throw ConfigurationError(rig.path + ": there is no estimator '" + rig.estimator +
                             "'; there are: plate_outline, ring_mean");
  }
}

std::string Corrector::set_calibration(const msg::Calibration& calibration) {
  const std::string wrong = calibration_.take(calibration);
  if (wrong.empty()) use_calibration();
  return wrong;
}

std::string Corrector::name_lidar(const std::string& serial_number) {
  const bool used = calibration_.now().has_value();
  const std::string wrong = calibration_.name_lidar(serial_number);
  if (used == calibration_.now().has_value()) return {};
  use_calibration();
  return wrong;
}

void Corrector::use_calibration() {
  const auto& calibration = calibration_.now();
  rig_ = drawn_;
  if (calibration) rig_.geometry = calibrated_geometry(drawn_.geometry, *calibration);
  if (!rig_.plate || !estimator_) return;
  estimator_ = attitude_estimator(rig_.estimator, rig_.geometry);
  calibrated_ = calibration && tells_alpha(*calibration);
  alpha_sigma_deg_ = calibrated_ ? ::swivel::alpha_sigma_deg(*calibration) : 0.0;
  const auto shape = calibrated_ ? plate_shape_of(*calibration) : std::nullopt;
  if (calibrated_) rig_.plate->alpha_rad = rad_from_deg(calibration->alpha_deg());
  if (shape) rig_.plate->shape = *shape;
  watch_.calibrated(shape, calibrated_ ? m_from_mm(calibration->plate_residual_mm()) : 0.0);
}

msg::Attitude Corrector::correct(const msg::Sweep& sweep, OrganisedCloud& cloud) {
  msg::Attitude attitude = blank_attitude(sweep);
  if (!estimator_) {
    attitude.verdict(msg::VERDICT_MEASURED);
    attitude.phi_offset_deg(0.0);
    attitude.phi_offset_sigma_deg(0.0);
    return attitude;
  }
  attitude.estimator(rig_.estimator);
  attitude.alpha_deg(deg_from_rad(rig_.plate->alpha_rad));
  attitude.calibrated(calibrated_);
  const AttitudeEstimate estimate = (*estimator_)(cloud, *rig_.plate);
  const SeamEstimate seam = measure_seam(AlongAxis(cloud, rig_.geometry).cloud());
  fill(estimate, attitude);
  judge_turn(sweep, seam, attitude);
  if (attitude.verdict() == msg::VERDICT_GOOD) {
    attitude.warning(watch_.add(estimate, seam));
    transform_cloud(base_from_start(rig_.geometry, rad_from_deg(attitude.phi_offset_deg())), cloud);
    if (sweep.lines_missing() > 0) attitude.reason("the plate is whole; " + sweep.reason());
  }
  return attitude;
}

// A plate that is seen well says nothing of a shaft that lost steps before or after it.
void Corrector::judge_turn(const msg::Sweep& sweep, const SeamEstimate& seam,
                           msg::Attitude& attitude) const {
  attitude.seam_deg(deg_from_rad(seam.further_rad));
  attitude.seam_sigma_deg(deg_from_rad(seam.sigma_rad));
  if (attitude.verdict() != msg::VERDICT_GOOD) return;
  const bool naive = sweep.action_sequence() == msg::SEQUENCE_NAIVE;
  if (!naive && !seam_is_open(seam)) return;
  attitude.verdict(msg::VERDICT_SEAM_OPEN);
  if (!seam_is_open(seam)) {
    attitude.reason("the motor started with the sweep (naive): its first lines are bent");
    return;
  }
  attitude.reason(in_words(
      "the shaft turned ", spoken_deg(std::abs(seam.further_rad)), " +- ",
      spoken_deg(seam.sigma_rad), seam.further_rad < 0.0 ? " deg less" : " deg further",
      " than said between the sweep's first and last lines: steps lost, or speed not constant"));
}

void Corrector::fill(const AttitudeEstimate& estimate, msg::Attitude& attitude) const {
  attitude.verdict(to_message(estimate.verdict));
  attitude.reason(estimate.reason);
  attitude.points_used(static_cast<std::uint32_t>(estimate.points_used));
  attitude.edges_used(static_cast<std::uint32_t>(estimate.edges_used));
  attitude.residual_mm(mm_from_m(estimate.residual_m));
  if (estimate.verdict != AttitudeVerdict::kGood) return;
  attitude.beta_deg(deg_from_rad(estimate.beta_rad));
  attitude.beta_sigma_deg(deg_from_rad(estimate.beta_sigma_rad));
  attitude.phi_offset_deg(deg_from_rad(phi_offset_rad(rig_.plate->alpha_rad, estimate.beta_rad)));
  attitude.phi_offset_sigma_deg(std::hypot(attitude.beta_sigma_deg(), alpha_sigma_deg_));
}

const char* verdict_word(msg::Verdict verdict) {
  switch (verdict) {
    case msg::VERDICT_GOOD:
      return "good";
    case msg::VERDICT_MEASURED:
      return "measured";
    case msg::VERDICT_NO_PLATE:
      return "no_plate";
    case msg::VERDICT_TOO_FEW_POINTS:
      return "too_few_points";
    case msg::VERDICT_FOREIGN_OBJECT:
      return "foreign_object";
    case msg::VERDICT_LINES_MISSING:
      return "lines_missing";
    case msg::VERDICT_SEAM_OPEN:
      return "seam_open";
  }
  return "unknown";
}

}  // namespace swivel
