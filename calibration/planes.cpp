#include "calibration/planes.hpp"

#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "calibration/seen_plane.hpp"

namespace swivel {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr int kMostRansacRounds = 4000;
constexpr std::size_t kRansacEffort = 8'000'000;  // points looked at for one plane: the fewer are
                                                  // left, the more rounds, and the small are found
constexpr int kRefinements = 4;
constexpr double kKeptSigmas = 3.0;  // of the points that a plane is fitted to
constexpr double kThickest = 0.9;    // rms over band: evenly filled space has more
constexpr std::size_t kLeastPointsOfAPlane = 50;
constexpr std::size_t kOtherPlanes = 6;  // floor, roof, tables: looked for besides the walls

// Distance from a plane, positive on the rig's side.
double height_over(const Plane& plane, const Eigen::Vector3f& point) {
  return plane.normal.dot(point.cast<double>()) + plane.distance_m;
}

Points valid_points(const OrganisedCloud& cloud) {
  Points points;
  points.reserve(cloud.points.size());
  for (const CloudPoint& point : cloud.points) {
    if (point.valid()) points.emplace_back(point.x_m, point.y_m, point.z_m);
  }
  return points;
}

// Every so many of them, over the whole cloud.
PclCloud::Ptr sample(const Points& points, std::size_t count) {
  const std::size_t stride =
      std::max<std::size_t>(1, points.size() / std::max<std::size_t>(1, count));
  auto sampled = pcl::make_shared<PclCloud>();
  for (std::size_t index = 0; index < points.size(); index += stride) {
    sampled->emplace_back(points[index].x(), points[index].y(), points[index].z());
  }
  return sampled;
}

Plane facing_origin(const Eigen::Vector3d& normal, double offset_m) {
  Plane plane;
  const double sign = offset_m < 0.0 ? -1.0 : 1.0;
  plane.normal = sign * normal.normalized();
  plane.distance_m = sign * offset_m / normal.norm();
  return plane;
}

// RANSAC with its own fixed seed: the same cloud gives the same planes.
std::optional<Plane> segment(const PclCloud::Ptr& cloud, const PlaneOptions& options) {
  const auto model = pcl::make_shared<SeenPlane>(cloud, options.lever_arm_m);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(model, options.band_m);
  const auto rounds = static_cast<int>(kRansacEffort / cloud->size());
  consensus.setMaxIterations(std::min(rounds, kMostRansacRounds));
  if (!consensus.computeModel()) return std::nullopt;
  Eigen::VectorXf found;
  pcl::Indices inliers;
  consensus.getModelCoefficients(found);
  consensus.getInliers(inliers);
  if (found.size() < 4 || inliers.size() < kLeastPointsOfAPlane) return std::nullopt;
  Plane plane = facing_origin(found.head<3>().cast<double>(), static_cast<double>(found[3]));
  plane.points = inliers.size();
  return plane;
}

void remove_near(const Plane& plane, double band_m, PclCloud& cloud) {
  const auto near = [&](const pcl::PointXYZ& point) {
    return std::abs(height_over(plane, point.getVector3fMap())) <= band_m;
  };
  cloud.erase(std::remove_if(cloud.begin(), cloud.end(), near), cloud.end());
  cloud.width = static_cast<std::uint32_t>(cloud.size());
  cloud.height = 1;
}

// Sums from which mean and scatter of points come, about a place near to them.
struct Moments {
  std::size_t count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& point) {
    ++count;
    sum += point;
    squares += point * point.transpose();
  }
  Eigen::Vector3d mean() const { return sum / static_cast<double>(count); }
  Eigen::Matrix3d scatter() const {
    return squares / static_cast<double>(count) - mean() * mean().transpose();
  }
};

// Told by where the point's ray meets its own plane: by the noisy point itself, more of the noise
// towards the other plane than away from it would go, and turn the fit.
bool near_another(const std::vector<Plane>& planes, std::size_t own, const Eigen::Vector3f& point,
                  double strip_m) {
  const double along_ray = -planes[own].distance_m / planes[own].normal.dot(point.cast<double>());
  const Eigen::Vector3f foot = static_cast<float>(along_ray) * point;
  for (std::size_t other = 0; other < planes.size(); ++other) {
    if (other != own && std::abs(height_over(planes[other], foot)) < strip_m) return true;
  }
  return false;
}

Moments moments_near(const Points& points, const std::vector<Plane>& planes, std::size_t own,
                     double band_m, const PlaneOptions& options) {
  const auto furthest_m =
      static_cast<float>(furthest_seen_m(planes[own].distance_m, options.lever_arm_m));
  Moments moments;
  for (const Eigen::Vector3f& point : points) {
    if (std::abs(height_over(planes[own], point)) > band_m) continue;
    if (point.squaredNorm() > furthest_m * furthest_m) continue;
    if (near_another(planes, own, point, options.shared_strip_m)) continue;
    moments.add(point.cast<double>());
  }
  return moments;
}

// Total least squares, eq. (8): the normal is the direction of least scatter.
std::optional<Plane> fit(const Moments& moments) {
  if (moments.count < kLeastPointsOfAPlane) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.scatter());
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  Plane plane = facing_origin(normal, -normal.dot(moments.mean()));
  plane.rms_m = std::sqrt(std::max(0.0, solver.eigenvalues()(0)));
  plane.points = moments.count;
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(plane.normal);
  const double spread_m2 = level.dot(moments.scatter() * level) / level.squaredNorm();
  plane.length_m = std::sqrt(12.0 * std::max(spread_m2, 0.0));
  plane.height_m = std::sqrt(12.0 * std::max(moments.scatter()(2, 2), 0.0));
  plane.azimuth_sigma_rad =
      plane.rms_m / std::sqrt(static_cast<double>(plane.points) * std::max(spread_m2, 1e-12));
  return plane;
}

// Fits a plane to the points near it, and again to those near the better plane.
std::optional<Plane> refine(const Points& points, std::vector<Plane> planes, std::size_t own,
                            const PlaneOptions& options) {
  double band_m = options.band_m;
  for (int round = 0; round < kRefinements; ++round) {
    const auto better = fit(moments_near(points, planes, own, band_m, options));
    if (!better) return std::nullopt;
    planes[own] = *better;
    band_m = std::clamp(kKeptSigmas * better->rms_m, 0.2 * options.band_m, 2.0 * options.band_m);
  }
  return planes[own];
}

// The largest planes, one after the other, each taken out before the next is looked for: so
// floor and roof are gone when the walls come, and no upright plane is made of their points.
std::vector<Plane> find_roughly(const Points& points, std::size_t count,
                                const PlaneOptions& options) {
  const PclCloud::Ptr rest = sample(points, options.sampled);
  const auto share =
      static_cast<std::size_t>(options.least_share * static_cast<double>(rest->size()));
  const std::size_t least = std::max(kLeastPointsOfAPlane, share);
  std::vector<Plane> planes;
  while (planes.size() < count && rest->size() >= least) {
    const auto plane = segment(rest, options);
    if (!plane || plane->points < least) break;
    planes.push_back(*plane);
    remove_near(*plane, 2.0 * options.band_m, *rest);
  }
  return planes;
}

}  // namespace

std::vector<Plane> find_planes(const OrganisedCloud& cloud, std::size_t count,
                               const PlaneOptions& options) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // finding none is an answer, no error
  const Points points = valid_points(cloud);
  const std::vector<Plane> rough = find_roughly(points, count, options);
  std::vector<Plane> planes;
  for (std::size_t own = 0; own < rough.size(); ++own) {
    const auto plane = refine(points, rough, own, options);
    if (plane && plane->rms_m <= kThickest * options.band_m) planes.push_back(*plane);
  }
  std::sort(planes.begin(), planes.end(),
            [](const Plane& one, const Plane& other) { return one.points > other.points; });
  return planes;
}

std::vector<Plane> find_walls(const OrganisedCloud& cloud, std::size_t count,
                              const PlaneOptions& options) {
  std::vector<Plane> walls = find_planes(cloud, count + kOtherPlanes, options);
  const auto leans = [&options](const Plane& plane) {
    return std::abs(plane.normal.z()) > std::sin(options.wall_tilt_rad);
  };
  walls.erase(std::remove_if(walls.begin(), walls.end(), leans), walls.end());
  if (walls.size() > count) walls.resize(count);
  return walls;
}

}  // namespace swivel
