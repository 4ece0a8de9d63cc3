#include "calibration/room_walls.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"

namespace swivel {
namespace {

constexpr double kSameDistanceM = 0.05;                   // of one surface in two sweeps,
constexpr double kSameAzimuthRad = rad_from_deg(3.0);     // whose betas may be as far apart
constexpr double kConsensusScaleRad = rad_from_deg(0.5);  // within which surfaces are square
constexpr double kLeastShareOfExtent = 1.0 / 3.0;         // of the largest, to be the wall behind

// A plane that several sweeps saw at the same place.
struct Surface {
  double azimuth_rad = 0.0;  // of the first that saw it, less its beta
  double distance_m = 0.0;
  std::vector<const Plane*> by_sweep;
  // Once all have been seen:
  std::optional<std::size_t> side;  // none: it is far from all four
  double error_rad = 0.0;           // off its side, if alpha were as drawn
  double extent_m2 = 0.0;
};
using Surfaces = std::vector<Surface>;

double turned(double angle_rad) {
  return std::remainder(angle_rad, 2 * kPi);
}

Surface* surface_of(const Plane& plane, double azimuth_rad, std::size_t sweep, Surfaces& surfaces) {
  Surface* nearest = nullptr;
  double least_m = kSameDistanceM;
  for (Surface& surface : surfaces) {
    const double off_m = std::abs(plane.distance_m - surface.distance_m);
    if (surface.by_sweep[sweep] != nullptr || off_m > least_m) continue;
    if (std::abs(turned(azimuth_rad - surface.azimuth_rad)) > kSameAzimuthRad) continue;
    nearest = &surface;
    least_m = off_m;
  }
  return nearest;
}

// What came and went, as people and doors do, is in fewer than half of the sweeps.
bool comes_and_goes(const Surface& surface) {
  const auto missed = std::count(surface.by_sweep.begin(), surface.by_sweep.end(), nullptr);
  return 2 * static_cast<std::size_t>(missed) >= surface.by_sweep.size();
}

Surfaces lasting_surfaces(const std::vector<AlphaSweep>& sweeps) {
  Surfaces surfaces;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    for (const Plane& plane : sweeps[sweep].walls) {
      const double azimuth_rad = plane.azimuth_rad() - sweeps[sweep].beta_rad;
      Surface* surface = surface_of(plane, azimuth_rad, sweep, surfaces);
      if (surface == nullptr) {
        surfaces.push_back(
            {azimuth_rad, plane.distance_m, std::vector<const Plane*>(sweeps.size()), {}, 0, 0});
        surface = &surfaces.back();
      }
      surface->by_sweep[sweep] = &plane;
    }
  }
  surfaces.erase(std::remove_if(surfaces.begin(), surfaces.end(), comes_and_goes), surfaces.end());
  return surfaces;
}

// Taken about one of them: those of a wall at the rig's other side lie about 180 deg, on either
// side of where angles wrap, and their plain median would be 0.
double median_error_rad(const std::vector<AlphaSweep>& sweeps, const Surface& surface,
                        std::size_t side, const AlphaOptions& options) {
  std::optional<double> first_rad;
  std::vector<double> off_rad;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    const Plane* const plane = surface.by_sweep[sweep];
    if (plane == nullptr) continue;
    const double error_rad =
        wall_error_rad(*plane, side, sweeps[sweep].beta_rad, options.initial_alpha_rad, options);
    if (!first_rad) first_rad = error_rad;
    off_rad.push_back(turned(error_rad - *first_rad));
  }
  return turned(*first_rad + median(off_rad));
}

double median_extent_m2(const Surface& surface) {
  std::vector<double> extents_m2;
  for (const Plane* plane : surface.by_sweep) {
    if (plane != nullptr) extents_m2.push_back(plane->length_m * plane->height_m);
  }
  return median(extents_m2);
}

void judge(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options, Surface& surface) {
  surface.extent_m2 = median_extent_m2(surface);
  for (std::size_t side = 0; side < kWalls; ++side) {
    const double error_rad = median_error_rad(sweeps, surface, side, options);
    if (std::abs(error_rad) > options.widest_skew_rad) continue;
    surface.side = side;
    surface.error_rad = error_rad;
  }
}

// How much of the room is square at that angle: of each side the surface that agrees best.
double agreement_m2(const Surfaces& surfaces, double error_rad) {
  std::array<double, kWalls> best_m2{};
  for (const Surface& surface : surfaces) {
    if (!surface.side) continue;
    const double off = (surface.error_rad - error_rad) / kConsensusScaleRad;
    best_m2[*surface.side] =
        std::max(best_m2[*surface.side], surface.extent_m2 / (1.0 + off * off));
  }
  return best_m2[0] + best_m2[1] + best_m2[2] + best_m2[3];
}

double most_agreed_error_rad(const Surfaces& surfaces) {
  double best_rad = 0.0;
  double best_m2 = -1.0;
  for (const Surface& surface : surfaces) {
    if (!surface.side) continue;
    const double agreed_m2 = agreement_m2(surfaces, surface.error_rad);
    if (agreed_m2 <= best_m2) continue;
    best_rad = surface.error_rad;
    best_m2 = agreed_m2;
  }
  return best_rad;
}

const Surface* larger(const Surface* one, const Surface* other) {
  return one == nullptr || other->extent_m2 > one->extent_m2 ? other : one;
}

// What one side has to show.
struct Side {
  const Surface* wall = nullptr;   // square to the others
  const Surface* askew = nullptr;  // the largest of those that are not
};

// Of two square surfaces, one before the other, the one behind is the wall, unless it is a strip.
Side side_of(const Surfaces& surfaces, std::size_t side, double agreed_rad,
             const AlphaOptions& options) {
  const auto square = [&](const Surface& surface) {
    return std::abs(surface.error_rad - agreed_rad) <= options.widest_corner_rad;
  };
  Side found;
  const Surface* largest = nullptr;
  for (const Surface& surface : surfaces) {
    if (surface.side != side) continue;
    (square(surface) ? largest : found.askew) =
        larger(square(surface) ? largest : found.askew, &surface);
  }
  for (const Surface& surface : surfaces) {
    if (surface.side != side || !square(surface)) continue;
    if (surface.extent_m2 < kLeastShareOfExtent * largest->extent_m2) continue;
    if (found.wall == nullptr || surface.distance_m > found.wall->distance_m) found.wall = &surface;
  }
  return found;
}

std::string in_a_list(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string why_not_square(const RoomWalls& room, const Surfaces& surfaces,
                           const AlphaOptions& options) {
  std::string reason = in_words("only ", room.walls.size(), " of 4 walls are square to each other");
  for (const std::string& remark : room.remarks) reason += "; " + remark;
  const auto elsewhere = std::count_if(surfaces.begin(), surfaces.end(),
                                       [](const Surface& surface) { return !surface.side; });
  if (elsewhere > 0) {
    reason += in_words("; ", elsewhere, " other upright planes are more than ",
                       spoken_deg(options.widest_skew_rad), " deg off the rig's sides");
  }
  return reason +
         ": set the rig square to the room or give the room's yaw, and use a room with three or "
         "four plain walls in range";
}

}  // namespace

double wall_error_rad(const Plane& plane, std::size_t side, double beta_rad, double alpha_rad,
                      const AlphaOptions& options) {
  // The direction in O in which a wall's normal, which looks at the rig, should point.
  const double expected_rad = options.room_yaw_rad + static_cast<double>(side) * kPi / 2 + kPi;
  return turned(plane.azimuth_rad() + alpha_rad - beta_rad - expected_rad);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

RoomWalls find_room_walls(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options) {
  Surfaces surfaces = lasting_surfaces(sweeps);
  for (Surface& surface : surfaces) judge(sweeps, options, surface);
  const double agreed_rad = most_agreed_error_rad(surfaces);
  RoomWalls room;
  std::vector<std::string> askew;
  std::vector<std::string> unseen;
  for (std::size_t side = 0; side < kWalls; ++side) {
    const Side found = side_of(surfaces, side, agreed_rad, options);
    if (found.wall != nullptr) {
      room.walls.push_back({side, found.wall->by_sweep});
    } else if (found.askew != nullptr) {
      const double off_deg = spoken_deg(found.askew->error_rad - agreed_rad);
      askew.push_back(in_words(kWallNames[side], " by ", off_deg, " deg"));
    } else {
      unseen.emplace_back(kWallNames[side]);
    }
  }
  if (!askew.empty()) room.remarks.push_back("left out, too far off square: " + in_a_list(askew));
  if (!unseen.empty()) room.remarks.push_back("no wall seen: " + in_a_list(unseen));
  if (room.walls.size() < 2 || room.walls.size() <= askew.size()) {
    room.reason = why_not_square(room, surfaces, options);
  }
  return room;
}

}  // namespace swivel
