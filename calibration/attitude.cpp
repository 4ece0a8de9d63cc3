#include "calibration/attitude.hpp"

#include "calibration/plate_outline.hpp"
#include "calibration/ring_mean.hpp"

namespace swivel {

std::optional<AttitudeEstimator> attitude_estimator(const std::string& name,
                                                    const RigGeometry& rig) {
  if (name == "ring_mean") {
    return [rig](const OrganisedCloud& cloud, const PlateGeometry& plate) {
      return estimate_by_ring_mean(cloud, plate, rig);
    };
  }
  if (name == "plate_outline") {
    return [rig](const OrganisedCloud& cloud, const PlateGeometry& plate) {
      return estimate_by_plate_outline(cloud, plate, rig);
    };
  }
  return std::nullopt;
}

}  // namespace swivel
