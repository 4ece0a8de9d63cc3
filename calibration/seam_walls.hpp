// One wall, seen from both ends of the sweep, and how far the two views are turned against each
// other. docs/geometry.md (13).
#pragma once

#include <optional>
#include <vector>

#include "calibration/seam_sightings.hpp"

namespace swivel {

// An upright wall from above: distance + x cos(azimuth) + y sin(azimuth) = 0.
struct SeamWall {
  double azimuth_rad = 0.0;  // of its normal, towards the rig
  double distance_m = 0.0;
};

// How many sightings lie on the wall; those a little off count in part.
double support(const std::vector<Sighting>& sightings, const SeamWall& wall);

// What a wall says when the last lines' sightings are turned by further_rad.
struct WallClosure {
  SeamWall wall;
  double further_rad = 0.0;
  double sigma_rad = 0.0;
  // Of all sightings near the wall, those left out of the fit too: what a bent wall has more of.
  double misfit_m = 0.0;
};

// The longest walls that these sightings of one end show, three at most.
std::vector<SeamWall> walls_among(const std::vector<Sighting>& sightings);

// Fits wall and turn together, beginning near both; none where an end does not see that wall.
std::optional<WallClosure> fit_closure(const SeamSightings& seam, const SeamWall& wall,
                                       double further_rad);

}  // namespace swivel
