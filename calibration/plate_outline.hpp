// The attitude by the plate's outline: the likeliest azimuth over every beam near its edges.
// docs/geometry.md (14) to (17).
#pragma once

#include "calibration/attitude.hpp"

namespace swivel {

AttitudeEstimate estimate_by_plate_outline(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                           const RigGeometry& rig);

}  // namespace swivel
