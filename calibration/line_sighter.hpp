// Which plane each ray of a scan line meets, told by its range. docs/geometry.md (23).
#pragma once

#include <cstddef>
#include <vector>

#include "calibration/mounting_model.hpp"

namespace swivel {

// A plane in the frame in which the axis is at rest, and how far ranges to it scatter.
struct SightedPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // n . p = -distance
  double distance_m = 0.0;
  double range_sigma_m = 0.0;
  std::size_t rays = 0;
};

// Of a range to the plane, at that incidence: rays that graze scatter more.
double range_sigma_m(const SightedPlane& plane, double cosine);

// Where a ray meets a plane.
struct Meeting {
  double expected_m = 0.0;  // as the lidar would say it
  double cosine = 0.0;      // of normal and ray
};

struct RayOnPlane {
  static constexpr int kNoPlane = -1;
  static constexpr int kTwoPlanes = -2;

  int plane = kNoPlane;  // index, or one of these
  Meeting meeting;
  double off_m = 0.0;  // the range said, less that expected
};

class LineSighter {
 public:
  // Both must outlive it.
  LineSighter(const MountedBeams& beams, const std::vector<SightedPlane>& planes);

  // A ray each beam.
  std::vector<RayOnPlane> sight(const LineOfReadings& line);

 private:
  void turn(const ShaftTurn& shaft);
  RayOnPlane sight(std::size_t beam, double range_m);
  void meet_all(std::size_t beam);
  bool near_another(const RayOnPlane& ray) const;

  const MountedBeams& beams_;
  const std::vector<SightedPlane>& planes_;
  std::vector<Eigen::Vector3d> normals_;  // as the shaft stands, in the turning frame,
  std::vector<double> heights_m_;         // and the lidar's centre over the planes
  std::vector<Meeting> meetings_;         // of the ray in work
};

}  // namespace swivel
