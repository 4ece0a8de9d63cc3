// Which of the upright planes that the sweeps saw are the walls of the room: not the furniture,
// and nothing that is far from square.
#pragma once

#include <string>
#include <vector>

#include "calibration/alpha.hpp"

namespace swivel {

// One wall and what the sweeps saw of it.
struct RoomWall {
  std::size_t side = 0;                // as in Wall
  std::vector<const Plane*> by_sweep;  // null where the sweep did not see it
};

struct RoomWalls {
  std::vector<RoomWall> walls;       // at most one a side
  std::vector<std::string> remarks;  // walls left out, or not seen
  std::string reason;                // why refused, and what to do; else empty
};

RoomWalls find_room_walls(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options);

// Eq. (9): how far a wall of O' is off its place in O when the plate stands at alpha.
double wall_error_rad(const Plane& plane, std::size_t side, double beta_rad, double alpha_rad,
                      const AlphaOptions& options);

double median(std::vector<double> values);

}  // namespace swivel
