// The planes of a room as a mounting puts them, and how flat the same rays are under another.
#pragma once

#include <cstddef>
#include <vector>

#include "calibration/mounting_model.hpp"
#include "calibration/plane_sightings.hpp"

namespace swivel {

// The `count` largest, in the frame in which the axis is at rest.
std::vector<SightedPlane> find_sighted_planes(const SweepReadings& readings,
                                              const MountedBeams& beams, std::size_t count);

struct RayPlace {
  std::size_t line = 0;  // index
  std::size_t beam = 0;
};

// The rays whose points lie so near to the plane, as the mounting puts them.
std::vector<RayPlace> rays_near(const SightedPlane& plane, double reach_m,
                                const SweepReadings& readings, const MountedBeams& beams);

// How far the rays' points lie off the plane that fits them best, to the side of the origin;
// docs/geometry.md (8).
std::vector<double> off_their_plane_m(const std::vector<RayPlace>& rays,
                                      const SweepReadings& readings, const MountedBeams& beams);

// How thick the largest planes are under the rig file's mounting and under another: rms over the
// same rays, those that are near the planes under both. Where the lidar looks twice, only what both
// views see: elsewhere a surface that is not quite flat outweighs how well they agree. A plane
// square to the axis tells of no turn about it.
struct Thickness {
  double nominal_m = 0.0;
  double mounted_m = 0.0;
};
Thickness compare_thickness(const SweepReadings& readings, const RigGeometry& nominal,
                            const MountingVector& mounting);

}  // namespace swivel
