#include "calibration/attitude.hpp"

#include "calibration/plate_outline.hpp"
#include "calibration/ring_mean.hpp"
#include "calibration/transform_cloud.hpp"

namespace swivel {
namespace {

using Estimate = AttitudeEstimate (*)(const OrganisedCloud&, const PlateGeometry&,
                                      const RigGeometry&);

AttitudeEstimator along_axis(Estimate estimate, const RigGeometry& rig) {
  return [estimate, rig](const OrganisedCloud& cloud, const PlateGeometry& plate) {
    return estimate(AlongAxis(cloud, rig).cloud(), plate, rig);
  };
}

}  // namespace

std::optional<AttitudeEstimator> attitude_estimator(const std::string& name,
                                                    const RigGeometry& rig) {
  if (name == "ring_mean") return along_axis(estimate_by_ring_mean, rig);
  if (name == "plate_outline") return along_axis(estimate_by_plate_outline, rig);
  return std::nullopt;
}

}  // namespace swivel
