// The large surfaces of a room, and how far the points measured on them lie off the planes
// fitted to them (Yuan 2021, appendix B).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/organised_cloud.hpp"
#include "calibration/planes.hpp"

namespace swivel {

// Points within this of a plane count as the surface's; what is further off is something else.
inline constexpr double kSurfaceReach_m = 0.100;

// Seen from the rig: along the surface to the left, upwards, and off it towards the rig.
struct SurfacePoint {
  double along_m = 0.0;
  double up_m = 0.0;
  double off_m = 0.0;
  std::size_t line = 0;
};

struct Surface {
  Plane plane;
  std::string name;  // "wall at 90 deg": where it stands, seen from the rig
  std::vector<SurfacePoint> points;
  double sd_m = 0.0;          // of all its points' distances from the plane
  double share_within = 0.0;  // of them: within the lidar's own accuracy, 40 mm
};

enum class SurfaceKind { kUpright, kAny };

// The four largest. Points near two planes are nobody's. A floor runs along X.
std::vector<Surface> find_surfaces(const OrganisedCloud& cloud, SurfaceKind which);

// The place of a wall at which a sweep's first line ends and its last begins, or the reverse.
struct SeamPlace {
  std::size_t surface = 0;  // index
  double along_m = 0.0;
  double distance_m = 0.0;
};

// Where the ray from the axis at that azimuth first meets one of the walls.
std::optional<SeamPlace> seam_place(const std::vector<Surface>& walls, double azimuth_rad);

}  // namespace swivel
