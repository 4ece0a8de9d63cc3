// The attitude of one sweep: where its start position O' stands against the rig's front, told by
// a plate that is fixed to the rig. docs/geometry.md (5), Yuan 2021 section 4.1.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "calibration/plate_fit.hpp"
#include "calibration/rig.hpp"

namespace swivel {

enum class AttitudeVerdict { kGood, kNoPlate, kTooFewPoints, kForeignObject, kLinesMissing };

struct AttitudeEstimate {
  AttitudeVerdict verdict = AttitudeVerdict::kNoPlate;
  std::string reason;  // in words, with numbers; empty when good

  // Azimuth of the plate's middle line in O'. NaN unless good: what is not to be trusted is not
  // there to be used.
  double beta_rad = std::numeric_limits<double>::quiet_NaN();
  double beta_sigma_rad = std::numeric_limits<double>::quiet_NaN();

  std::size_t points_used = 0;
  std::size_t edges_used = 0;  // beams, or pairs of them, that see an edge of the plate
  double residual_m = std::numeric_limits<double>::quiet_NaN();  // rms distance from the plate
  std::optional<PlateFit> fit;  // of an estimator that makes one: what a calibration learns from
};

// Takes the raw cloud in O', as it was assembled.
using AttitudeEstimator =
    std::function<AttitudeEstimate(const OrganisedCloud&, const PlateGeometry&)>;

// The estimator of that name for that rig; none when there is no such name.
std::optional<AttitudeEstimator> attitude_estimator(const std::string& name,
                                                    const RigGeometry& rig);

// Eq. (10): turns the cloud from O' into O about Z.
inline double phi_offset_rad(double alpha_rad, double beta_rad) {
  return alpha_rad - beta_rad;
}

}  // namespace swivel
