#include "components/swivel/report/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace swivel {
namespace {

// The same wall in two clouds: corrected to some degree, or at least homed.
constexpr double kSameAzimuthRad = rad_from_deg(15.0);
constexpr double kSameDistance_m = 0.3;

constexpr double kWidestCornerRad = rad_from_deg(4.0);  // of a room that is called square
constexpr double kWidestSkewRad = rad_from_deg(20.0);   // beyond it, which side is which?

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double between_half_turns(double angle_rad) {
  return std::remainder(angle_rad, 2 * kPi);
}

const Plane* same_wall(const Plane& wall, const std::vector<Plane>& others) {
  const Plane* nearest = nullptr;
  double nearest_rad = kSameAzimuthRad;
  for (const Plane& other : others) {
    const double off_rad = std::abs(between_half_turns(wall.azimuth_rad() - other.azimuth_rad()));
    if (off_rad > nearest_rad) continue;
    if (std::abs(wall.distance_m - other.distance_m) > kSameDistance_m) continue;
    nearest = &other;
    nearest_rad = off_rad;
  }
  return nearest;
}

// The sweep whose walls are the sharpest: a corrected one with the most points on them.
std::optional<std::size_t> best_seen(const std::vector<std::vector<Plane>>& walls,
                                     const std::vector<SweepAttitude>& attitudes) {
  std::optional<std::size_t> best;
  std::size_t most = 0;
  for (std::size_t sweep = 0; sweep < walls.size(); ++sweep) {
    std::size_t points = 0;
    for (const Plane& wall : walls[sweep]) points += wall.points;
    if (!attitudes[sweep].corrected || points <= most) continue;
    best = sweep;
    most = points;
  }
  return best;
}

using Turns = std::vector<std::optional<double>>;  // a sweep each

Turns turned_against_each_other(const std::vector<std::vector<Plane>>& walls, std::size_t reference,
                                const std::vector<SweepAttitude>& attitudes) {
  Turns turns;
  std::vector<double> corrected;
  for (std::size_t sweep = 0; sweep < walls.size(); ++sweep) {
    turns.push_back(turned_against_rad(walls[sweep], walls[reference]));
    if (turns.back() && attitudes[sweep].corrected) corrected.push_back(*turns.back());
  }
  const double middle_rad = median_of(corrected);  // the reference itself is one
  for (auto& turned : turns)
    if (turned) *turned -= middle_rad;
  return turns;
}

}  // namespace

void judge_by_start(double true_start_rad, SweepAttitude& attitude) {
  attitude.without_rad = between_half_turns(true_start_rad);
  if (attitude.corrected)
    attitude.with_rad = between_half_turns(true_start_rad - attitude.phi_offset_rad);
}

void judge_by_walls(double walls_turned_rad, SweepAttitude& attitude) {
  const double error_rad = between_half_turns(-walls_turned_rad);
  attitude.with_rad = attitude.corrected ? error_rad : kUnknownAngle;
  attitude.without_rad =
      between_half_turns(error_rad + (attitude.corrected ? attitude.phi_offset_rad : 0.0));
}

std::optional<double> turned_against_rad(const std::vector<Plane>& walls,
                                         const std::vector<Plane>& reference) {
  std::vector<double> turns_rad;
  for (const Plane& wall : walls) {
    if (const Plane* const same = same_wall(wall, reference))
      turns_rad.push_back(between_half_turns(wall.azimuth_rad() - same->azimuth_rad()));
  }
  if (turns_rad.empty()) return std::nullopt;
  return median_of(std::move(turns_rad));
}

std::optional<double> turned_from_square_rad(const std::vector<Plane>& walls, double room_yaw_rad) {
  std::vector<double> turns_rad;
  turns_rad.reserve(walls.size());
  for (const Plane& wall : walls)
    turns_rad.push_back(std::remainder(wall.azimuth_rad() - room_yaw_rad, kPi / 2));
  if (turns_rad.size() < 2) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(turns_rad.begin(), turns_rad.end());
  if (*highest - *lowest > kWidestCornerRad) return std::nullopt;
  const double turned_rad = median_of(std::move(turns_rad));
  return std::abs(turned_rad) <= kWidestSkewRad ? std::optional(turned_rad) : std::nullopt;
}

Reference judge_by_walls(const std::vector<std::vector<Plane>>& walls, double room_yaw_rad,
                         std::vector<SweepAttitude>& attitudes) {
  const auto corrected = std::count_if(attitudes.begin(), attitudes.end(),
                                       [](const auto& attitude) { return attitude.corrected; });
  const auto best = best_seen(walls, attitudes);
  const bool several = corrected > 1 && best;
  Turns turns;
  if (several) {
    turns = turned_against_each_other(walls, *best, attitudes);
  } else {
    for (const auto& seen : walls) turns.push_back(turned_from_square_rad(seen, room_yaw_rad));
  }
  bool any = false;
  for (std::size_t sweep = 0; sweep < turns.size(); ++sweep) {
    if (turns[sweep]) judge_by_walls(*turns[sweep], attitudes[sweep]);
    any = any || turns[sweep];
  }
  if (!any) return Reference::kNone;
  return several ? Reference::kOtherSweeps : Reference::kSquareWalls;
}

double AngleStatistics::largest_rad() const {
  return std::max(std::abs(lowest_rad), std::abs(highest_rad));
}

AngleStatistics statistics_of(const std::vector<double>& angles_rad) {
  AngleStatistics statistics;
  double sum_rad = 0.0;
  double squares = 0.0;
  for (const double angle_rad : angles_rad) {
    if (std::isnan(angle_rad)) continue;
    ++statistics.count;
    sum_rad += angle_rad;
    squares += angle_rad * angle_rad;
    statistics.lowest_rad = std::fmin(statistics.lowest_rad, angle_rad);  // NaN gives way
    statistics.highest_rad = std::fmax(statistics.highest_rad, angle_rad);
  }
  if (statistics.count == 0) return statistics;
  statistics.mean_rad = sum_rad / static_cast<double>(statistics.count);
  statistics.rms_rad = std::sqrt(squares / static_cast<double>(statistics.count));
  return statistics;
}

double map_error_m(double distance_m, double phi_error_rad) {
  return distance_m * std::tan(phi_error_rad);
}

double kept_up_to_m(double phi_error_rad) {
  if (std::isnan(phi_error_rad)) return phi_error_rad;
  const double error_a_metre = std::abs(map_error_m(1.0, phi_error_rad));
  return error_a_metre * kMapReach_m <= kMapBand_m ? kMapReach_m : kMapBand_m / error_a_metre;
}

std::vector<ModeEvaluation> by_mode(const std::vector<SweepAttitude>& attitudes) {
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> errors;
  for (const SweepAttitude& attitude : attitudes) {
    errors[attitude.mode].first.push_back(attitude.without_rad);
    errors[attitude.mode].second.push_back(attitude.with_rad);
  }
  std::vector<ModeEvaluation> modes;
  modes.reserve(errors.size());
  for (const auto& [mode, both] : errors) {
    modes.push_back(
        {mode, both.first.size(), statistics_of(both.first), statistics_of(both.second)});
  }
  return modes;
}

std::optional<double> papers_largest_rad(int mode) {
  if (mode == 1) return rad_from_deg(1.2456);
  if (mode == 7) return rad_from_deg(0.2865);
  return std::nullopt;
}

}  // namespace swivel
