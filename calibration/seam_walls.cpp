#include "calibration/seam_walls.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr double kNearWallM = 0.02;  // where walls are looked for
constexpr std::size_t kMostWalls = 3;
constexpr std::size_t kLeastOfAWall = 3;  // sightings at an end
constexpr std::size_t kTriedPlaces = 24;  // a wall is tried through every two of so many
constexpr int kClosureRounds = 6;
constexpr double kKeptScatters = 4.0;  // of the sightings that a wall is fitted to
constexpr double kLeastKeptM = 0.004;
constexpr double kMisfitM = 0.06;
constexpr double kMostDriftRad = rad_from_deg(4.0);  // of a fit from where it began
constexpr double kBlockRad = rad_from_deg(5.0);      // within which sightings err together

std::optional<SeamWall> wall_through(const Eigen::Vector2d& one_m, const Eigen::Vector2d& other_m) {
  const Eigen::Vector2d along = other_m - one_m;
  if (along.norm() < 1e-3) return std::nullopt;
  Eigen::Vector2d normal(-along.y() / along.norm(), along.x() / along.norm());
  if (normal.dot(one_m) > 0.0) normal = -normal;
  return SeamWall{std::atan2(normal.y(), normal.x()), -normal.dot(one_m)};
}

double off_wall_m(const SeamWall& wall, const Eigen::Vector2d& place_m) {
  return wall.distance_m + place_m.x() * std::cos(wall.azimuth_rad) +
         place_m.y() * std::sin(wall.azimuth_rad);
}

SeamWall longest_wall(const std::vector<Sighting>& sightings) {
  const std::size_t stride = 1 + sightings.size() / kTriedPlaces;
  SeamWall best;
  double most = 0.0;
  for (std::size_t one = 0; one < sightings.size(); one += stride) {
    for (std::size_t other = one + stride; other < sightings.size(); other += stride) {
      const auto wall = wall_through(sightings[one].place_m, sightings[other].place_m);
      const double score = wall ? support(sightings, *wall) : 0.0;
      if (score > most) {
        most = score;
        best = *wall;
      }
    }
  }
  return best;
}

// A sighting against the wall: how far off, and how that goes with azimuth, distance and turn.
struct WallRow {
  double off_m;
  Eigen::Vector3d slope;
};

// Makes the rows of one end; the last lines' places are turned first.
class WallRowMaker {
 public:
  WallRowMaker(const WallClosure& at, bool last)
      : last_(last),
        distance_m_(at.wall.distance_m),
        cos_(std::cos(at.wall.azimuth_rad - (last ? at.further_rad : 0.0))),
        sin_(std::sin(at.wall.azimuth_rad - (last ? at.further_rad : 0.0))) {}

  WallRow operator()(const Sighting& sighting) const {
    const double along_m = cos_ * sighting.place_m.y() - sin_ * sighting.place_m.x();
    const double towards_m = cos_ * sighting.place_m.x() + sin_ * sighting.place_m.y();
    return {distance_m_ + towards_m, {along_m, 1.0, last_ ? -along_m : 0.0}};
  }

 private:
  bool last_;
  double distance_m_;
  double cos_;  // turning the wall back is as good as turning the places
  double sin_;
};

// Least squares in azimuth, distance and turn, and what its covariance is made of.
struct ClosureEquations {
  std::size_t first = 0;  // sightings
  std::size_t last = 0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  double off_squares_m2 = 0.0;
  double noise_m2 = 0.0;
  std::map<long, Eigen::Vector3d> block_pulls;  // of neighbours together

  void add(const Sighting& sighting, const WallRow& row, bool is_last) {
    ++(is_last ? last : first);
    squares += row.slope * row.slope.transpose();
    pull += row.slope * row.off_m;
    off_squares_m2 += row.off_m * row.off_m;
    noise_m2 += sighting.sigma_m * sighting.sigma_m;
    const long block = std::lround(sighting.away_rad / kBlockRad - 0.5);
    auto [sum, is_new] = block_pulls.try_emplace(is_last ? -1 - block : block);
    if (is_new) sum->second.setZero();
    sum->second += row.slope * row.off_m;
  }
  bool enough() const { return first >= kLeastOfAWall && last >= kLeastOfAWall; }
  double count() const { return static_cast<double>(first + last); }
  // Of a sighting: what is left over, and at least the beams' noise.
  double scatter_m2() const {
    return std::max(off_squares_m2 / (count() - 3.0), noise_m2 / count());
  }
};

ClosureEquations equations_at(const SeamSightings& seam, const WallClosure& at, double near_m) {
  ClosureEquations equations;
  const auto add = [&](const std::vector<Sighting>& sightings, bool last) {
    const WallRowMaker wall_row_of(at, last);
    for (const Sighting& sighting : sightings) {
      const WallRow row = wall_row_of(sighting);
      if (std::abs(row.off_m) <= near_m) equations.add(sighting, row, last);
    }
  };
  add(seam.first, false);
  add(seam.last, true);
  return equations;
}

// The larger of two: as if sightings erred alone, and as if those of a block erred together.
double turn_sigma_rad(const ClosureEquations& equations) {
  const Eigen::Matrix3d inverse = equations.squares.inverse();
  Eigen::Matrix3d together = Eigen::Matrix3d::Zero();
  for (const auto& [block, pull] : equations.block_pulls) together += pull * pull.transpose();
  const auto blocks = static_cast<double>(equations.block_pulls.size());
  const double few = blocks > 3.0 ? blocks / (blocks - 3.0) : 1.0;
  const double alone_rad2 = equations.scatter_m2() * inverse(2, 2);
  return std::sqrt(std::max(alone_rad2, few * (inverse * together * inverse)(2, 2)));
}

}  // namespace

double support(const std::vector<Sighting>& sightings, const SeamWall& wall) {
  const Eigen::Vector2d normal(std::cos(wall.azimuth_rad), std::sin(wall.azimuth_rad));
  double sum = 0.0;
  for (const Sighting& sighting : sightings) {
    const double off = (wall.distance_m + normal.dot(sighting.place_m)) / kNearWallM;
    sum += std::max(0.0, 1.0 - off * off);
  }
  return sum;
}

std::vector<SeamWall> walls_among(const std::vector<Sighting>& sightings) {
  std::vector<Sighting> rest = sightings;
  std::vector<SeamWall> walls;
  while (walls.size() < kMostWalls && rest.size() >= kLeastOfAWall) {
    const SeamWall wall = longest_wall(rest);
    const auto on_wall = [&wall](const Sighting& sighting) {
      return std::abs(off_wall_m(wall, sighting.place_m)) < kNearWallM;
    };
    const auto kept = std::remove_if(rest.begin(), rest.end(), on_wall);
    if (rest.end() - kept < static_cast<std::ptrdiff_t>(kLeastOfAWall)) break;
    rest.erase(kept, rest.end());
    walls.push_back(wall);
  }
  return walls;
}

std::optional<WallClosure> fit_closure(const SeamSightings& seam, const SeamWall& wall,
                                       double further_rad) {
  WallClosure closure{wall, further_rad, 0.0, 0.0};
  double near_m = 1.5 * kNearWallM;
  for (int round = 0; round < kClosureRounds; ++round) {
    const ClosureEquations equations = equations_at(seam, closure, near_m);
    if (!equations.enough()) return std::nullopt;
    const Eigen::Vector3d step = -equations.squares.ldlt().solve(equations.pull);
    closure.wall.azimuth_rad += step[0];
    closure.wall.distance_m += step[1];
    closure.further_rad += step[2];
    if (!(std::abs(closure.further_rad - further_rad) < kMostDriftRad)) return std::nullopt;
    closure.sigma_rad = turn_sigma_rad(equations);
    const double kept_m = kKeptScatters * std::sqrt(equations.scatter_m2());
    near_m = std::clamp(kept_m, kLeastKeptM, near_m);
  }
  closure.misfit_m = std::sqrt(equations_at(seam, closure, kMisfitM).scatter_m2());
  return closure;
}

}  // namespace swivel
