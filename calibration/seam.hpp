// Whether the shaft turned as far as it was told: the two halves of the scan plane look at the
// same walls, one at the sweep's beginning and the other at its end. docs/geometry.md (13).
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "calibration/units.hpp"

namespace swivel {

struct SeamEstimate {
  // How much further than the cloud was assembled with the shaft turned from the first line to
  // the last; negative where steps were lost. NaN where no wall tells it.
  double further_rad = std::numeric_limits<double>::quiet_NaN();
  double sigma_rad = std::numeric_limits<double>::quiet_NaN();
  std::size_t walls = 0;  // seen from both ends of the sweep
  std::string reason;     // why it is not known; else empty
};

// Takes the raw cloud in O', its Z the axis of rotation, of a sweep of about half a turn.
SeamEstimate measure_seam(const OrganisedCloud& cloud);

// When the two halves disagree by more than chance, and by enough to matter.
struct SeamAlarm {
  double least_rad = rad_from_deg(0.5);
  double least_sigmas = 5.0;
};

// False where the seam is not known: nothing is said then.
bool seam_is_open(const SeamEstimate& seam, const SeamAlarm& alarm = {});

}  // namespace swivel
