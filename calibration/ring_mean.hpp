// The paper's own estimator (Yuan 2021, section 4.1): the mean of the points in a ring about the
// axis. Good to some 0.5 deg rms in mode 1 and 0.1 deg in mode 7 at a range noise of 13 mm.
#pragma once

#include "calibration/attitude.hpp"

namespace swivel {

AttitudeEstimate estimate_by_ring_mean(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                       const RigGeometry& rig);

}  // namespace swivel
