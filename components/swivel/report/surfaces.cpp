#include "components/swivel/report/surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibration/units.hpp"
#include "components/swivel/report/evaluation.hpp"

namespace swivel {
namespace {

constexpr std::size_t kSurfaces = 4;
constexpr std::size_t kPlanesLookedFor = 10;  // floor, roof and furniture among them

double off_plane_m(const Plane& plane, const Eigen::Vector3d& point) {
  return plane.normal.dot(point) + plane.distance_m;
}

// The only plane within reach of the point; none where there are two, or none.
std::optional<std::size_t> only_plane_near(const std::vector<Plane>& planes,
                                           const Eigen::Vector3d& point) {
  std::optional<std::size_t> only;
  for (std::size_t index = 0; index < planes.size(); ++index) {
    if (std::abs(off_plane_m(planes[index], point)) > kSurfaceReach_m) continue;
    if (only) return std::nullopt;
    only = index;
  }
  return only;
}

bool upright(const Plane& plane) {
  return std::abs(plane.normal.z()) <= std::sin(PlaneOptions().wall_tilt_rad);
}

std::string name_of(const Plane& plane) {
  if (upright(plane)) {
    const double towards_deg = deg_from_rad(std::atan2(-plane.normal.y(), -plane.normal.x()));
    return "wall at " + std::to_string(std::lround(towards_deg)) + " deg";
  }
  if (plane.normal.z() > 0.9) return "floor";
  return plane.normal.z() < -0.9 ? "ceiling" : "slanting surface";
}

// Two directions in the plane.
struct Directions {
  explicit Directions(const Plane& plane)
      : along((upright(plane) ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY())
                  .cross(plane.normal)
                  .normalized()),
        up(plane.normal.cross(along)) {
    if (upright(plane)) along = -along;  // to the left, as the rig sees it
  }
  Eigen::Vector3d along;
  Eigen::Vector3d up;
};

void measure(Surface& surface) {
  double squares = 0.0;
  std::size_t within = 0;
  for (const SurfacePoint& point : surface.points) {
    squares += point.off_m * point.off_m;
    within += std::abs(point.off_m) <= kLidarBand_m ? 1 : 0;
  }
  const auto count = static_cast<double>(surface.points.size());
  surface.sd_m = std::sqrt(squares / count);
  surface.share_within = static_cast<double>(within) / count;
}

// Index into planes of the largest that are asked for; they are sorted by size.
std::vector<std::size_t> chosen(const std::vector<Plane>& planes, SurfaceKind which) {
  std::vector<std::size_t> indices;
  for (std::size_t index = 0; index < planes.size() && indices.size() < kSurfaces; ++index)
    if (which == SurfaceKind::kAny || upright(planes[index])) indices.push_back(index);
  return indices;
}

}  // namespace

std::vector<Surface> find_surfaces(const OrganisedCloud& cloud, SurfaceKind which) {
  const std::vector<Plane> planes = find_planes(cloud, kPlanesLookedFor);
  const std::vector<std::size_t> indices = chosen(planes, which);
  std::vector<Surface> surfaces;
  std::vector<Directions> directions;
  for (const std::size_t index : indices) {
    surfaces.push_back({planes[index], name_of(planes[index]), {}, 0.0, 0.0});
    directions.emplace_back(planes[index]);
  }
  for (std::size_t place = 0; place < cloud.points.size(); ++place) {
    const CloudPoint& measured = cloud.points[place];
    if (!measured.valid()) continue;
    const Eigen::Vector3d point =
        Eigen::Vector3f(measured.x_m, measured.y_m, measured.z_m).cast<double>();
    const auto near = only_plane_near(planes, point);
    if (!near) continue;
    const auto found = std::find(indices.begin(), indices.end(), *near);
    if (found == indices.end()) continue;
    const auto surface = static_cast<std::size_t>(found - indices.begin());
    surfaces[surface].points.push_back({directions[surface].along.dot(point),
                                        directions[surface].up.dot(point),
                                        off_plane_m(planes[*near], point), place / cloud.beams});
  }
  for (Surface& surface : surfaces) measure(surface);
  return surfaces;
}

std::optional<SeamPlace> seam_place(const std::vector<Surface>& walls, double azimuth_rad) {
  const Eigen::Vector3d towards(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  std::optional<SeamPlace> nearest;
  for (std::size_t index = 0; index < walls.size(); ++index) {
    const Plane& plane = walls[index].plane;
    const double facing = -plane.normal.dot(towards);
    if (!upright(plane) || facing < 0.2) continue;
    const double distance_m = plane.distance_m / facing;
    if (nearest && nearest->distance_m <= distance_m) continue;
    const double along_m = Directions(plane).along.dot(towards) * distance_m;
    nearest = SeamPlace{index, along_m, distance_m};
  }
  return nearest;
}

}  // namespace swivel
