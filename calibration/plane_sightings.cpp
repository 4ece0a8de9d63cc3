#include "calibration/plane_sightings.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calibration/line_sighter.hpp"

namespace swivel {
namespace {

constexpr std::size_t kSectors = 120;
constexpr double kPriorTurnRad = 0.5;  // of a plane, so that no sum is singular
constexpr double kPriorShiftM = 1.0;
constexpr double kLeastSigmaM = 0.0003;  // ranges come in millimetres
constexpr double kMostSigmaM = 0.05;     // what scatters more is no plane

using Eigen::Vector3d;

struct PlaneAxes {
  Vector3d along;  // the normal turns towards these
  Vector3d across;
};

PlaneAxes axes_of(const Vector3d& normal) {
  const Vector3d along = normal.unitOrthogonal();
  return {along, normal.cross(along)};
}

// Eq. (23): how far the expected range moves, over its sigma, taken where the plane is met.
PlaneVector derivative_of(const RayOnPlane& ray, const SightedPlane& plane, const PlaneAxes& axes,
                          const MountedBeams& beams, const LineOfReadings& line, std::size_t beam) {
  const ShaftTurn shaft = beams.shaft_at(line, beam);
  const Vector3d normal = shaft.to_turning(plane.normal);
  const Vector3d met = shaft.to_rest(beams.turning_point(beam, ray.meeting.expected_m));
  PlaneVector derivative;
  derivative << beams.moves_along(normal, line, beam, ray.meeting.expected_m), axes.along.dot(met),
      axes.across.dot(met), 1.0;
  return derivative / (ray.meeting.cosine * range_sigma_m(plane, ray.meeting.cosine));
}

void add_ray(const PlaneVector& derivative, double off, PlaneVector& sector, PlaneSums& sums) {
  sums.information.selfadjointView<Eigen::Lower>().rankUpdate(derivative);
  sector += off * derivative;
  sums.squares += off * off;
  ++sums.rays;
}

// What a plane's own values answer to the mounting's: H_mp H_pp^-1.
Eigen::Matrix<double, kMountingValues, kPlaneValues> answer_of(const PlaneSums& sums) {
  const Eigen::Matrix3d own = sums.information.bottomRightCorner<kPlaneValues, kPlaneValues>();
  return own.ldlt()
      .solve(sums.information.bottomLeftCorner<kPlaneValues, kMountingValues>())
      .transpose();
}

}  // namespace

PlaneSightings sight_planes(const SweepReadings& readings, const MountedBeams& beams,
                            const std::vector<SightedPlane>& planes) {
  const std::size_t lines_of_sector = std::max<std::size_t>(1, readings.lines.size() / kSectors);
  const std::size_t sectors = readings.lines.size() / lines_of_sector + 1;
  PlaneSightings sightings;
  sightings.planes.resize(planes.size());
  std::vector<PlaneAxes> axes;
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    sightings.planes[plane].by_sector.assign(sectors, PlaneVector::Zero());
    sightings.planes[plane].information.bottomRightCorner<3, 3>().diagonal()
        << std::pow(kPriorTurnRad, -2),
        std::pow(kPriorTurnRad, -2), std::pow(kPriorShiftM, -2);
    axes.push_back(axes_of(planes[plane].normal));
  }
  sightings.explained.assign(readings.lines.size() * readings.beams(), 0);
  LineSighter sighter(beams, planes);
  for (std::size_t index = 0; index < readings.lines.size(); ++index) {
    const LineOfReadings& line = readings.lines[index];
    const std::vector<RayOnPlane> rays = sighter.sight(line);
    for (std::size_t beam = 0; beam < rays.size(); ++beam) {
      const RayOnPlane& ray = rays[beam];
      sightings.explained[index * rays.size() + beam] = ray.plane != RayOnPlane::kNoPlane ? 1 : 0;
      if (ray.plane < 0) continue;
      const auto own = static_cast<std::size_t>(ray.plane);
      PlaneSums& sums = sightings.planes[own];
      add_ray(derivative_of(ray, planes[own], axes[own], beams, line, beam),
              ray.off_m / range_sigma_m(planes[own], ray.meeting.cosine),
              sums.by_sector[index / lines_of_sector], sums);
    }
  }
  for (PlaneSums& sums : sightings.planes) {
    const PlaneMatrix whole = sums.information.selfadjointView<Eigen::Lower>();
    sums.information = whole;
    for (const PlaneVector& sector : sums.by_sector) sums.gradient += sector;
  }
  return sightings;
}

MountingEquations without_planes(const PlaneSightings& sightings) {
  MountingEquations equations;
  for (const PlaneSums& sums : sightings.planes) {
    const auto answer = answer_of(sums);
    equations.information +=
        sums.information.topLeftCorner<kMountingValues, kMountingValues>() -
        answer * sums.information.bottomLeftCorner<kPlaneValues, kMountingValues>();
    equations.groups.resize(sums.by_sector.size(), MountingVector::Zero());
    for (std::size_t sector = 0; sector < sums.by_sector.size(); ++sector) {
      equations.groups[sector] += sums.by_sector[sector].head<kMountingValues>() -
                                  answer * sums.by_sector[sector].tail<kPlaneValues>();
    }
  }
  for (const MountingVector& group : equations.groups) equations.gradient += group;
  return equations;
}

std::vector<SightedPlane> moved_planes(const std::vector<SightedPlane>& planes,
                                       const PlaneSightings& sightings,
                                       const MountingVector& mounting_moved) {
  std::vector<SightedPlane> moved = planes;
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    const PlaneSums& sums = sightings.planes[plane];
    const Eigen::Matrix3d own = sums.information.bottomRightCorner<kPlaneValues, kPlaneValues>();
    const Eigen::Vector3d pull =
        sums.gradient.tail<kPlaneValues>() +
        sums.information.bottomLeftCorner<kPlaneValues, kMountingValues>() * mounting_moved;
    const Eigen::Vector3d step = -own.ldlt().solve(pull);
    const PlaneAxes axes = axes_of(planes[plane].normal);
    const Vector3d normal = planes[plane].normal + step[0] * axes.along + step[1] * axes.across;
    moved[plane].normal = normal.normalized();
    moved[plane].distance_m = (planes[plane].distance_m + step[2]) / normal.norm();
    moved[plane].rays = sums.rays;
    if (sums.rays > 1) {
      const double scatter = std::sqrt(sums.squares / static_cast<double>(sums.rays));
      moved[plane].range_sigma_m =
          std::clamp(scatter * planes[plane].range_sigma_m, kLeastSigmaM, kMostSigmaM);
    }
  }
  return moved;
}

}  // namespace swivel
