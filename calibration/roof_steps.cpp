#include "calibration/roof_steps.hpp"

#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

constexpr double kMostLeanOfRoof = 0.09;             // sine: 5 deg out of square to the axis
constexpr double kFurthestFromAxis = 0.70710678118;  // cosine: 45 deg, beyond are corners
constexpr double kReachOfRoofSigmas = 3.5;

// Alismail and Browning's: the half scans brought together, the bias as the rig file has it.
MountingVector without_bias(const SweepReadings& readings, const RigGeometry& nominal) {
  MountingPrior prior = prior_of(nominal);
  prior.sigma[kMountingBias] = 0.0;
  const auto fit = fit_half_scans(readings, nominal, prior, prior.nominal);
  return fit ? fit->solution.value : prior.nominal;
}

MountingVector bias_alone(const RigGeometry& nominal, const SymmetricRaysFit& rays) {
  MountingVector mounting = mounting_of(nominal);
  if (std::isfinite(rays.bias_rad)) mounting[kMountingBias] = rays.bias_rad;
  return mounting;
}

const SightedPlane* roof_of(const std::vector<SightedPlane>& planes) {
  const SightedPlane* roof = nullptr;
  for (const SightedPlane& plane : planes) {
    if (plane.normal.head<2>().norm() > kMostLeanOfRoof) continue;
    if (roof == nullptr || plane.rays > roof->rays) roof = &plane;
  }
  return roof;
}

RoofLook rays_on(const SightedPlane& roof, const SweepReadings& readings,
                 const MountedBeams& beams) {
  RoofLook look;
  for (const RayPlace& ray :
       rays_near(roof, kReachOfRoofSigmas * roof.range_sigma_m, readings, beams)) {
    const Eigen::Vector3d& direction = beams.direction(ray.beam);
    if (std::abs(direction.z()) < kFurthestFromAxis) continue;
    const auto range_m = static_cast<double>(readings.lines[ray.line].ranges_m[ray.beam]);
    look.rays.push_back(ray);
    look.along_m.push_back(std::copysign(range_m * direction.head<2>().norm(), direction.y()));
    if (2 * ray.line < readings.lines.size()) ++look.front;
  }
  return look;
}

}  // namespace

std::optional<RoofLook> look_at_roof(const SweepReadings& readings, const RigGeometry& nominal,
                                     const MountingFit& fit) {
  const SightedPlane* const roof = roof_of(fit.planes);
  if (roof == nullptr) return std::nullopt;
  RoofLook look = rays_on(*roof, readings, {nominal, fit.solution.value, readings});
  if (look.rays.empty()) return std::nullopt;
  const std::array<MountingVector, kRoofSteps> steps = {
      mounting_of(nominal), without_bias(readings, nominal),
      bias_alone(nominal, fit.symmetric_rays), fit.solution.value};
  for (std::size_t step = 0; step < kRoofSteps; ++step) {
    look.off_m[step] = off_their_plane_m(look.rays, readings, {nominal, steps[step], readings});
  }
  return look;
}

double mean_deviation_m(const std::vector<double>& off_m) {
  double sum_m = 0.0;
  for (const double off : off_m) sum_m += std::abs(off);
  return off_m.empty() ? 0.0 : sum_m / static_cast<double>(off_m.size());
}

}  // namespace swivel
