// Where the halves of a sweep's first and last lines meet a wall.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "calibration/organised_cloud.hpp"

namespace swivel {

// Half a line on a wall, seen from above: the mean of the beams on it. A line's hundreds of
// beams make a millimetre of it, and what is common to a line shows as scatter from line to line.
struct Sighting {
  Eigen::Vector2d place_m;
  double sigma_m = 0.0;   // of the mean, from the beams' noise alone
  double away_rad = 0.0;  // from the end of the sweep, as assembled
};

// The two halves that meet at one seam; in order, beginning at the seam.
struct SeamSightings {
  std::vector<Sighting> first;  // by one half, in the first lines
  std::vector<Sighting> last;   // by the other half, in the last lines
};

// Both seams, each as far as window_rad to its two sides. A turn of 180 deg is assumed.
std::array<SeamSightings, 2> sightings_at_seams(const OrganisedCloud& cloud, double window_rad);

}  // namespace swivel
