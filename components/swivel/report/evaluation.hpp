// The evaluation of Yuan 2021, section 5, as numbers.
//
// phi_error has the paper's sign: positive where the cloud lies clockwise of where it should,
// seen from above. Turned by phi_error, counter-clockwise, it would stand right.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "calibration/planes.hpp"

namespace swivel {

inline constexpr double kUnknownAngle = std::numeric_limits<double>::quiet_NaN();

// What the errors are measured against.
enum class Reference {
  kNone,
  kTruth,        // of a simulator
  kOtherSweeps,  // the walls, against the median of all sweeps: blind to what all have in common
  kSquareWalls,  // the walls, against the room's own square directions
};

// Of one sweep. NaN where not known.
struct SweepAttitude {
  std::size_t sweep = 0;  // counted from 0
  int mode = 0;
  bool corrected = false;
  double phi_offset_rad = kUnknownAngle;
  double sigma_rad = kUnknownAngle;
  double without_rad = kUnknownAngle;  // phi_error of the cloud as if its sweep had begun at 0
  double with_rad = kUnknownAngle;     // phi_error of the corrected cloud
};

// Fills in both errors from the azimuth at which the sweep really began.
void judge_by_start(double true_start_rad, SweepAttitude& attitude);

// Fills in both from the angle by which the walls of the cloud, corrected or not, lie
// counter-clockwise of their place.
void judge_by_walls(double walls_turned_rad, SweepAttitude& attitude);

// How far the walls lie counter-clockwise of the same walls in another cloud: the median over
// those that both have. None where they have none in common.
std::optional<double> turned_against_rad(const std::vector<Plane>& walls,
                                         const std::vector<Plane>& reference);

// How far they lie counter-clockwise of a square room whose front is at azimuth room_yaw. None
// where they are no square room, or one too far turned to tell its sides.
std::optional<double> turned_from_square_rad(const std::vector<Plane>& walls, double room_yaw_rad);

// Fills in the errors of all sweeps by their walls, a list a sweep, and says against what.
Reference judge_by_walls(const std::vector<std::vector<Plane>>& walls, double room_yaw_rad,
                         std::vector<SweepAttitude>& attitudes);

struct AngleStatistics {
  std::size_t count = 0;
  double mean_rad = kUnknownAngle;
  double rms_rad = kUnknownAngle;
  double lowest_rad = kUnknownAngle;
  double highest_rad = kUnknownAngle;

  // The largest either way.
  double largest_rad() const;
};

// Of those that are known.
AngleStatistics statistics_of(const std::vector<double>& angles_rad);

inline constexpr double kMapBand_m = 0.050;    // the error that a map may have
inline constexpr double kMapReach_m = 10.0;    // of the lidar
inline constexpr double kLidarBand_m = 0.040;  // the lidar's own accuracy

// Eq. Y21: how far a point at that distance is off its place.
double map_error_m(double distance_m, double phi_error_rad);

// The distance up to which the map's error stays in its band, at most the lidar's reach.
double kept_up_to_m(double phi_error_rad);

struct ModeEvaluation {
  int mode = 0;
  std::size_t sweeps = 0;
  AngleStatistics without;
  AngleStatistics with;
};

// In order of mode.
std::vector<ModeEvaluation> by_mode(const std::vector<SweepAttitude>& attitudes);

// The largest errors of Yuan's corrected clouds, where the paper tells them.
std::optional<double> papers_largest_rad(int mode);

}  // namespace swivel
