// Where the plate really stands: alpha, from sweeps in a room whose walls are square to the rig.
// docs/geometry.md (9), (11), (12); Yuan 2021 section 4.2.
//
// What it cannot see: a rig that does not stand square in the room is off by as much as alpha
// then is. Whoever knows the room's yaw gives it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/planes.hpp"
#include "calibration/units.hpp"

namespace swivel {

// What one sweep tells, both in its own frame O'.
struct AlphaSweep {
  double beta_rad = 0.0;
  double beta_sigma_rad = 0.0;
  std::vector<Plane> walls;  // and whatever else stands upright
  std::string name;          // as the user knows it; empty: its place, from 1
};

struct AlphaOptions {
  double initial_alpha_rad = rad_from_deg(30.0);  // as drawn
  double room_yaw_rad = 0.0;                      // azimuth in O of the room's forward direction
  std::size_t least_sweeps = 3;                   // fewer cannot show that one of them is wrong
  double widest_skew_rad = rad_from_deg(20.0);    // of a wall against the rig's front
  double widest_corner_rad = rad_from_deg(2.0);   // of a wall off square, or it is left out
  double widest_sweep_sigmas = 5.0;               // of one sweep off the others
  double robust_scale_rad = rad_from_deg(0.1);    // beyond which a wall counts for less
  double wall_floor_rad = rad_from_deg(0.05);     // no wall is trusted further, however sharp
  int most_iterations = 100;
};

enum class Wall { kFront, kLeft, kBack, kRight };  // at azimuth 0, 90, 180, 270 deg in O
inline constexpr std::size_t kWalls = 4;
inline constexpr std::array<const char*, kWalls> kWallNames = {"front", "left", "back", "right"};

struct AlphaFit {
  double alpha_rad = std::numeric_limits<double>::quiet_NaN();
  double sigma_rad = std::numeric_limits<double>::quiet_NaN();  // one standard deviation, of both:
  double sweeps_sigma_rad = 0.0;                                // falls with their number
  double walls_sigma_rad = 0.0;                                 // walls out of square: stays
  double residual_rms_rad = 0.0;
  std::array<double, kWalls> wall_angles_rad{};  // each wall's own, off square; NaN where none
  // Of the sweeps about the walls' angles, by beta's sigma and that of each normal.
  double chi_square = 0.0;
  std::size_t degrees_of_freedom = 0;
  bool model_holds = true;  // chi_square is not larger than chance allows, one in a thousand
  std::size_t sweeps_used = 0;
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> remarks;  // in words: what was left out, what to doubt
};

struct AlphaResult {
  std::optional<AlphaFit> fit;  // none: refused
  std::string reason;           // then in words what to do; else empty
};

AlphaResult fit_alpha(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options = {});

// How many more sweeps like those used bring alpha's sigma down to this; none when the walls
// themselves do not allow it, however many sweeps there are.
std::optional<std::size_t> more_sweeps_for(const AlphaFit& fit, double sigma_rad);

}  // namespace swivel
