#include "calibration/mounted_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calibration/organised_cloud.hpp"
#include "calibration/planes.hpp"
#include "calibration/two_views.hpp"

namespace swivel {
namespace {

constexpr double kLeastShareOfPlane = 0.01;  // of the sweep's points
constexpr double kBandOfRange = 0.03;        // a small scene has its planes near to one another
constexpr double kThinnestBandM = 0.01;
constexpr std::size_t kPlanesLookedAt = 8;
constexpr std::size_t kLargestPlanes = 3;  // of them
constexpr double kReachSigmas = 3.0;

Eigen::Vector3d point_at_rest(const RayPlace& ray, const SweepReadings& readings,
                              const MountedBeams& beams) {
  const LineOfReadings& line = readings.lines[ray.line];
  const auto range_m = static_cast<double>(line.ranges_m[ray.beam]);
  return beams.shaft_at(line, ray.beam).to_rest(beams.turning_point(ray.beam, range_m));
}

// As the assembler would put it, in the frame in which the axis is at rest.
OrganisedCloud cloud_under(const SweepReadings& readings, const MountedBeams& beams) {
  OrganisedCloud cloud(readings.lines.size(), readings.beams());
  for (std::size_t line = 0; line < readings.lines.size(); ++line) {
    for (std::size_t beam = 0; beam < readings.beams(); ++beam) {
      const Eigen::Vector3f point = point_at_rest({line, beam}, readings, beams).cast<float>();
      cloud.line(line)[beam] = {point.x(), point.y(), point.z(), 0.0F};
    }
  }
  return cloud;
}

std::vector<RayPlace> still_near(const std::vector<RayPlace>& rays, double reach_m,
                                 const SweepReadings& readings, const MountedBeams& beams) {
  const std::vector<double> off_m = off_their_plane_m(rays, readings, beams);
  std::vector<RayPlace> near;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    if (std::abs(off_m[ray]) <= reach_m) near.push_back(rays[ray]);
  }
  return near;
}

// All of them where there is but one view.
std::vector<RayPlace> seen_by_both(std::vector<RayPlace> rays, const SweepReadings& readings) {
  const auto views = views_of_lines(readings);
  if (!views) return rays;
  const auto once = [&views](const RayPlace& ray) { return (*views)[ray.line] == View::kOnlyOne; };
  rays.erase(std::remove_if(rays.begin(), rays.end(), once), rays.end());
  return rays;
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

std::vector<SightedPlane> find_sighted_planes(const SweepReadings& readings,
                                              const MountedBeams& beams, std::size_t count) {
  PlaneOptions options;
  options.least_share = kLeastShareOfPlane;
  options.band_m =
      std::clamp(kBandOfRange * median_range_m(readings), kThinnestBandM, options.band_m);
  options.shared_strip_m = 2.0 * options.band_m;
  options.lever_arm_m = beams.lever_arm_m().head<2>().norm();
  std::vector<SightedPlane> planes;
  for (const Plane& plane : find_planes(cloud_under(readings, beams), count, options)) {
    planes.push_back({plane.normal, plane.distance_m, plane.rms_m, plane.points});
  }
  return planes;
}

std::vector<RayPlace> rays_near(const SightedPlane& plane, double reach_m,
                                const SweepReadings& readings, const MountedBeams& beams) {
  std::vector<RayPlace> rays;
  for (std::size_t line = 0; line < readings.lines.size(); ++line) {
    for (std::size_t beam = 0; beam < readings.beams(); ++beam) {
      const Eigen::Vector3d point = point_at_rest({line, beam}, readings, beams);
      if (std::abs(plane.normal.dot(point) + plane.distance_m) <= reach_m)
        rays.push_back({line, beam});
    }
  }
  return rays;
}

std::vector<double> off_their_plane_m(const std::vector<RayPlace>& rays,
                                      const SweepReadings& readings, const MountedBeams& beams) {
  if (rays.empty()) return {};
  std::vector<Eigen::Vector3d> points;
  points.reserve(rays.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const RayPlace& ray : rays) {
    points.push_back(point_at_rest(ray, readings, beams));
    mean += points.back();
  }
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
    scatter += (point - mean) * (point - mean).transpose();
  Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (normal.dot(mean) > 0.0) normal = -normal;
  std::vector<double> off_m;
  off_m.reserve(points.size());
  for (const Eigen::Vector3d& point : points) off_m.push_back(normal.dot(point - mean));
  return off_m;
}

Thickness compare_thickness(const SweepReadings& readings, const RigGeometry& nominal,
                            const MountingVector& mounting) {
  const MountedBeams before(nominal, mounting_of(nominal), readings);
  const MountedBeams after(nominal, mounting, readings);
  std::vector<std::vector<RayPlace>> planes;
  for (const SightedPlane& plane : find_sighted_planes(readings, before, kPlanesLookedAt)) {
    const double reach_m = kReachSigmas * plane.range_sigma_m;
    const auto rays = seen_by_both(rays_near(plane, reach_m, readings, before), readings);
    planes.push_back(still_near(rays, reach_m, readings, after));
  }
  std::sort(planes.begin(), planes.end(),
            [](const auto& one, const auto& other) { return one.size() > other.size(); });
  planes.resize(std::min(planes.size(), kLargestPlanes));
  Thickness thickness;
  for (const std::vector<RayPlace>& rays : planes) {
    thickness.nominal_m += std::pow(rms(off_their_plane_m(rays, readings, before)), 2);
    thickness.mounted_m += std::pow(rms(off_their_plane_m(rays, readings, after)), 2);
  }
  const double count = std::max(1.0, static_cast<double>(planes.size()));
  thickness.nominal_m = std::sqrt(thickness.nominal_m / count);
  thickness.mounted_m = std::sqrt(thickness.mounted_m / count);
  return thickness;
}

}  // namespace swivel
