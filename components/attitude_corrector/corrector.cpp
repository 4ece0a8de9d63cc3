#include "components/attitude_corrector/corrector.hpp"

#include <cmath>
#include <limits>

#include "calibration/transform_cloud.hpp"
#include "components/common/calibration_file.hpp"
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

Corrector::Corrector(const RigFile& rig) : rig_(rig) {
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
  alpha_deg_ = deg_from_rad(rig.plate->alpha_rad);
}

std::string Corrector::set_calibration(const msg::Calibration& calibration) {
  const double sigma_deg = ::swivel::alpha_sigma_deg(calibration);
  if (!std::isfinite(calibration.alpha_deg()) || !std::isfinite(sigma_deg)) {
    return "its alpha or the variance of it is not a number; calibrate again";
  }
  alpha_deg_ = calibration.alpha_deg();
  alpha_sigma_deg_ = sigma_deg;
  calibrated_ = true;
  return {};
}

msg::Attitude Corrector::correct(const msg::Sweep& sweep, OrganisedCloud& cloud) const {
  msg::Attitude attitude = blank_attitude(sweep);
  if (!estimator_) {
    attitude.verdict(msg::VERDICT_MEASURED);
    attitude.phi_offset_deg(0.0);
    attitude.phi_offset_sigma_deg(0.0);
    return attitude;
  }
  attitude.estimator(rig_.estimator);
  attitude.alpha_deg(alpha_deg_);
  attitude.calibrated(calibrated_);
  fill(estimate(cloud), attitude);
  if (attitude.verdict() == msg::VERDICT_GOOD) {
    transform_cloud(base_from_start(rig_.geometry, rad_from_deg(attitude.phi_offset_deg())), cloud);
    if (sweep.lines_missing() > 0) attitude.reason("the plate is whole; " + sweep.reason());
  }
  return attitude;
}

// The estimator looks along the axis, wherever that stands in the base.
AttitudeEstimate Corrector::estimate(const OrganisedCloud& cloud) const {
  const Eigen::Isometry3d& T_base_axis = rig_.geometry.T_base_axis;
  if (T_base_axis.isApprox(Eigen::Isometry3d::Identity())) return (*estimator_)(cloud, *rig_.plate);
  OrganisedCloud about_axis = cloud;
  transform_cloud(T_base_axis.inverse(), about_axis);
  return (*estimator_)(about_axis, *rig_.plate);
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
  attitude.phi_offset_deg(
      deg_from_rad(phi_offset_rad(rad_from_deg(alpha_deg_), estimate.beta_rad)));
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
