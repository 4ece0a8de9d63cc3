#include "calibration/seam_sightings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr double kNearestWallM = 0.3;  // level; what is nearer is the plate or the rig
constexpr double kFarthestWallM = 31.0;
constexpr double kDistanceBinM = 0.05;
constexpr double kHalfThicknessM = 0.06;  // of what counts as one upright surface
constexpr int kCentringRounds = 2;        // of centring on it
constexpr double kEndShare = 0.1;         // of its beams, left out at either end
constexpr std::size_t kEnoughLines = 45;  // of a window; twice as many take twice the time
constexpr std::size_t kLeastBeamsOnWall = 20;

struct LevelBeam {
  Eigen::Vector2d place_m;
  double distance_m;
};
using HalfLine = std::vector<LevelBeam>;

// Half 0 are the beams that are fired first.
HalfLine half_line(const OrganisedCloud& cloud, std::size_t line, std::size_t half) {
  const std::size_t middle = cloud.beams / 2;
  const std::size_t end = half == 0 ? middle : cloud.beams;
  HalfLine beams;
  beams.reserve(end);
  for (std::size_t beam = half == 0 ? 0 : middle; beam < end; ++beam) {
    const CloudPoint& point = cloud.line(line)[beam];
    const Eigen::Vector2d place_m(static_cast<double>(point.x_m), static_cast<double>(point.y_m));
    const double distance_m = place_m.norm();
    // Written so that NaN is left out.
    if (distance_m > kNearestWallM && distance_m < kFarthestWallM)
      beams.push_back({place_m, distance_m});
  }
  return beams;
}

// All beams on an upright wall have the same level distance, those on floor and roof have not.
std::optional<double> commonest_distance_m(const HalfLine& beams) {
  std::vector<std::size_t> bins(static_cast<std::size_t>(kFarthestWallM / kDistanceBinM) + 2);
  for (const LevelBeam& beam : beams)
    ++bins[static_cast<std::size_t>(beam.distance_m / kDistanceBinM)];
  std::size_t best = 0;
  for (std::size_t bin = 0; bin + 1 < bins.size(); ++bin) {
    if (bins[bin] + bins[bin + 1] > bins[best] + bins[best + 1]) best = bin;
  }
  if (bins[best] + bins[best + 1] < kLeastBeamsOnWall) return std::nullopt;
  return kDistanceBinM * static_cast<double>(best + 1);
}

// In the order fired, without the outermost: next to a wall's ends lie floor and roof.
HalfLine beams_on_wall(const HalfLine& beams, double wall_m) {
  HalfLine kept;
  for (const LevelBeam& beam : beams) {
    if (std::abs(beam.distance_m - wall_m) <= kHalfThicknessM) kept.push_back(beam);
  }
  const auto ends = static_cast<std::ptrdiff_t>(kEndShare * static_cast<double>(kept.size()));
  return {kept.begin() + ends, kept.end() - ends};
}

Sighting mean_sighting(const HalfLine& beams, double away_rad) {
  const auto count = static_cast<double>(beams.size());
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double distance_m = 0.0;
  for (const LevelBeam& beam : beams) {
    place_m += beam.place_m / count;
    distance_m += beam.distance_m / count;
  }
  double squares_m2 = 0.0;
  for (const LevelBeam& beam : beams) squares_m2 += std::pow(beam.distance_m - distance_m, 2);
  return {place_m, std::sqrt(squares_m2) / count, away_rad};
}

std::optional<Sighting> wall_in(const HalfLine& beams, double away_rad) {
  const auto wall_m = commonest_distance_m(beams);
  if (!wall_m) return std::nullopt;
  Sighting sighting;
  sighting.place_m = {*wall_m, 0.0};
  for (int round = 0; round < kCentringRounds; ++round) {
    const HalfLine kept = beams_on_wall(beams, sighting.place_m.norm());
    if (kept.size() < kLeastBeamsOnWall) return std::nullopt;
    sighting = mean_sighting(kept, away_rad);
  }
  return sighting;
}

std::vector<Sighting> sightings_of(const OrganisedCloud& cloud, std::size_t half, bool from_end,
                                   double window_rad) {
  const double line_rad = kPi / static_cast<double>(cloud.lines);
  std::vector<Sighting> sightings;
  const auto lines_in_window = static_cast<std::size_t>(window_rad / line_rad);
  const std::size_t stride = std::max<std::size_t>(1, lines_in_window / kEnoughLines);
  for (std::size_t away = 0; away < cloud.lines; away += stride) {
    const double away_rad = line_rad * static_cast<double>(away);
    if (away_rad > window_rad) break;
    const std::size_t line = from_end ? cloud.lines - 1 - away : away;
    if (const auto sighting = wall_in(half_line(cloud, line, half), away_rad)) {
      sightings.push_back(*sighting);
    }
  }
  return sightings;
}

}  // namespace

std::array<SeamSightings, 2> sightings_at_seams(const OrganisedCloud& cloud, double window_rad) {
  std::array<SeamSightings, 2> seams;
  for (std::size_t half = 0; half < 2; ++half) {
    seams.at(half).first = sightings_of(cloud, half, false, window_rad);
    seams.at(half).last = sightings_of(cloud, 1 - half, true, window_rad);
  }
  return seams;
}

}  // namespace swivel
