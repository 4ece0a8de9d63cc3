#include "calibration/seam.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "calibration/in_words.hpp"
#include "calibration/seam_sightings.hpp"
#include "calibration/seam_walls.hpp"

namespace swivel {
namespace {

using Seams = std::array<SeamSightings, 2>;

constexpr double kWindowRad = rad_from_deg(45.0);
constexpr double kNarrowestRad = rad_from_deg(5.0);
constexpr double kMostFurtherRad = rad_from_deg(20.0);  // that is looked for
constexpr double kFurtherStepRad = rad_from_deg(0.25);
constexpr double kClearlyMore = 1.02;  // of two turns as likely, the smaller

SeamWall turned_wall(SeamWall wall, double angle_rad) {
  wall.azimuth_rad += angle_rad;
  return wall;
}

struct SeamWalls {
  std::vector<SeamWall> first;
  std::vector<SeamWall> last;
};

// How much of what one end sees continues the walls that the other end sees.
double seam_agreement(const SeamSightings& seam, const SeamWalls& walls, double further_rad) {
  double sum = 0.0;
  for (const SeamWall& wall : walls.last)
    sum += support(seam.first, turned_wall(wall, further_rad));
  for (const SeamWall& wall : walls.first)
    sum += support(seam.last, turned_wall(wall, -further_rad));
  return sum;
}

// The turn for which both seams fit best, to kFurtherStepRad.
double search_further_rad(const Seams& seams, const std::array<SeamWalls, 2>& walls) {
  double best_rad = 0.0;
  double most = 0.0;
  for (double size_rad = 0.0; size_rad <= kMostFurtherRad; size_rad += kFurtherStepRad) {
    for (const double further_rad : {-size_rad, size_rad}) {
      const double sum = seam_agreement(seams[0], walls[0], further_rad) +
                         seam_agreement(seams[1], walls[1], further_rad);
      if (sum > kClearlyMore * most) {
        most = sum;
        best_rad = further_rad;
      }
    }
  }
  return best_rad;
}

bool same_wall(const SeamWall& one, const SeamWall& other) {
  const double apart_rad = std::remainder(one.azimuth_rad - other.azimuth_rad, 2.0 * kPi);
  return std::abs(apart_rad) < rad_from_deg(3.0) &&
         std::abs(one.distance_m - other.distance_m) < 0.1;
}

void add_closures(const SeamSightings& seam, const SeamWalls& walls, double further_rad,
                  std::vector<WallClosure>& closures) {
  std::vector<SeamWall> tried = walls.first;
  for (const SeamWall& wall : walls.last) tried.push_back(turned_wall(wall, further_rad));
  const auto known = [&closures](const SeamWall& wall) {
    return std::any_of(closures.begin(), closures.end(),
                       [&wall](const WallClosure& other) { return same_wall(wall, other.wall); });
  };
  for (const SeamWall& wall : tried) {
    if (known(wall)) continue;
    const auto closure = fit_closure(seam, wall, further_rad);
    if (closure && !known(closure->wall)) closures.push_back(*closure);
  }
}

// The weighted mean. Walls that disagree by more than their sigma widen it.
SeamEstimate weighted_mean_of(const std::vector<WallClosure>& closures) {
  double weight = 0.0;
  double sum = 0.0;
  for (const WallClosure& closure : closures) {
    weight += std::pow(closure.sigma_rad, -2);
    sum += closure.further_rad * std::pow(closure.sigma_rad, -2);
  }
  SeamEstimate estimate;
  estimate.further_rad = sum / weight;
  estimate.walls = closures.size();
  double chi_square = 0.0;
  for (const WallClosure& closure : closures) {
    chi_square += std::pow((closure.further_rad - estimate.further_rad) / closure.sigma_rad, 2);
  }
  const double freedom = std::max<double>(1.0, static_cast<double>(closures.size()) - 1.0);
  estimate.sigma_rad = std::sqrt(std::max(1.0, chi_square / freedom) / weight);
  return estimate;
}

constexpr double kLeastOtherRad = rad_from_deg(0.3);
constexpr double kNarrower = 0.7;  // each window than the one before
constexpr double kStraighter = 0.9;
constexpr double kChosenWidening = 1.4;  // of sigma: the best of a dozen windows flatters
constexpr double kOtherSigmas = 5.0;
constexpr double kOddSigmas = 4.0;
constexpr std::size_t kLeastToJudge = 3;  // of two that disagree, neither is known to be odd

// Without the wall that is furthest off the others, as long as there is one.
SeamEstimate robust_mean_of(std::vector<WallClosure> closures) {
  while (closures.size() >= kLeastToJudge) {
    std::size_t odd = 0;
    double most = 0.0;
    for (std::size_t own = 0; own < closures.size(); ++own) {
      std::vector<WallClosure> others = closures;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(own));
      const SeamEstimate mean = weighted_mean_of(others);
      const double off = std::abs(closures[own].further_rad - mean.further_rad) /
                         std::hypot(closures[own].sigma_rad, mean.sigma_rad);
      if (off > most) {
        most = off;
        odd = own;
      }
    }
    if (most < kOddSigmas) break;
    closures.erase(closures.begin() + static_cast<std::ptrdiff_t>(odd));
  }
  return weighted_mean_of(closures);
}

void cut_window(std::vector<Sighting>& sightings, double window_rad) {
  const auto beyond = [window_rad](const Sighting& sighting) {
    return sighting.away_rad > window_rad;
  };
  sightings.erase(std::remove_if(sightings.begin(), sightings.end(), beyond), sightings.end());
}

struct MeasuredSeam {
  SeamEstimate seam;
  double misfit_m = 0.0;
};

double rms_misfit_m(const std::vector<WallClosure>& closures) {
  double squares = 0.0;
  for (const WallClosure& closure : closures) squares += closure.misfit_m * closure.misfit_m;
  return std::sqrt(squares / static_cast<double>(closures.size()));
}

MeasuredSeam measure_in_windows(Seams seams, double first_rad, double last_rad) {
  std::array<SeamWalls, 2> walls;
  for (std::size_t seam = 0; seam < seams.size(); ++seam) {
    cut_window(seams.at(seam).first, first_rad);
    cut_window(seams.at(seam).last, last_rad);
    walls.at(seam) = {walls_among(seams.at(seam).first), walls_among(seams.at(seam).last)};
  }
  const double further_rad = search_further_rad(seams, walls);
  std::vector<WallClosure> closures;
  for (std::size_t seam = 0; seam < seams.size(); ++seam) {
    add_closures(seams.at(seam), walls.at(seam), further_rad, closures);
  }
  if (closures.empty()) {
    SeamEstimate unknown;
    unknown.reason = "no wall is seen from both ends of the sweep";
    return {unknown, 0.0};
  }
  return {robust_mean_of(closures), rms_misfit_m(closures)};
}

// What happened inside a window bends its walls; a narrower one that is free of it tells.
bool clearly_other(const SeamEstimate& wide, const SeamEstimate& narrow) {
  const double apart_rad = std::abs(narrow.further_rad - wide.further_rad);
  return narrow.walls > 0 && wide.walls > 0 &&
         apart_rad > std::max(kLeastOtherRad, kOtherSigmas * narrow.sigma_rad);
}

}  // namespace

SeamEstimate measure_seam(const OrganisedCloud& cloud) {
  const Seams seams = sightings_at_seams(cloud, kWindowRad);
  const MeasuredSeam wide = measure_in_windows(seams, kWindowRad, kWindowRad);
  MeasuredSeam best = wide;
  for (double narrow_rad = kNarrower * kWindowRad; narrow_rad > kNarrowestRad;
       narrow_rad *= kNarrower) {
    for (const MeasuredSeam& narrow : {measure_in_windows(seams, narrow_rad, kWindowRad),
                                       measure_in_windows(seams, kWindowRad, narrow_rad)}) {
      const bool straighter = narrow.misfit_m < kStraighter * best.misfit_m;
      const bool other =
          clearly_other(wide.seam, narrow.seam) || clearly_other(best.seam, narrow.seam);
      if (!straighter || !other) continue;
      best = narrow;
      best.seam.sigma_rad *= kChosenWidening;
    }
  }
  return best.seam;
}

bool seam_is_open(const SeamEstimate& seam, const SeamAlarm& alarm) {
  // False for NaN.
  return std::abs(seam.further_rad) >
         std::max(alarm.least_rad, alarm.least_sigmas * seam.sigma_rad);
}

}  // namespace swivel
