#include "calibration/plane_sightings.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

constexpr double kGateSigmas = 3.5;       // of a range from the plane's, to be of that plane
constexpr double kAmbiguousSigmas = 8.0;  // two planes as near to one another could both be meant
constexpr double kLeastIncidence = 0.26;  // cosine: 75 deg; rays that graze see edges and paint
constexpr double kGrazingTangent = 5.0;   // at which a range's variance is twice what it is
constexpr std::size_t kRaysOfARun = 16;
constexpr double kLeastShareOfRun = 0.7;  // fewer rays on the plane only pass through it
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

// Where a ray meets a plane.
struct Meeting {
  double expected_m;  // as the lidar would say it
  double cosine;      // of normal and ray
};

constexpr int kNoPlane = -1;
constexpr int kTwoPlanes = -2;

struct RayOnPlane {
  int plane = kNoPlane;
  Meeting meeting{};
  double off_m = 0.0;  // the range said, less that expected
};

double sigma_m(const SightedPlane& plane, double cosine) {
  const double tangent_squared = 1.0 / (cosine * cosine) - 1.0;
  return plane.range_sigma_m *
         std::sqrt(1.0 + tangent_squared / (kGrazingTangent * kGrazingTangent));
}

class LineSighter {
 public:
  LineSighter(const MountedBeams& beams, const std::vector<SightedPlane>& planes)
      : beams_(beams),
        planes_(planes),
        normals_(planes.size()),
        heights_m_(planes.size()),
        meetings_(planes.size()) {}

  std::vector<RayOnPlane> sight(const LineOfReadings& line) {
    std::vector<RayOnPlane> rays(line.ranges_m.size());
    turn(beams_.shaft_at(line, 0));
    for (std::size_t beam = 0; beam < rays.size(); ++beam) {
      if (std::isnan(line.ranges_m[beam])) continue;
      if (line.angle_per_beam_rad != 0.0) turn(beams_.shaft_at(line, beam));
      rays[beam] = sight(beam, static_cast<double>(line.ranges_m[beam]));
    }
    return rays;
  }

 private:
  void turn(const ShaftTurn& shaft) {
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
      normals_[plane] = shaft.to_turning(planes_[plane].normal);
      heights_m_[plane] = planes_[plane].distance_m + normals_[plane].dot(beams_.lever_arm_m());
    }
  }

  RayOnPlane sight(std::size_t beam, double range_m) {
    meet_all(beam);
    RayOnPlane ray;
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
      const Meeting& meeting = meetings_[plane];
      const double off_m = range_m - meeting.expected_m;
      if (!(std::abs(meeting.cosine) > kLeastIncidence) || meeting.expected_m < 0.0) continue;
      if (std::abs(off_m) > kGateSigmas * sigma_m(planes_[plane], meeting.cosine)) continue;
      if (ray.plane != kNoPlane && std::abs(off_m) > std::abs(ray.off_m)) continue;
      ray = {static_cast<int>(plane), meeting, off_m};
    }
    if (ray.plane != kNoPlane && near_another(ray)) ray.plane = kTwoPlanes;
    return ray;
  }

  void meet_all(std::size_t beam) {
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
      const double cosine = normals_[plane].dot(beams_.direction(beam));
      meetings_[plane] = {beams_.range_offset_m() - heights_m_[plane] / cosine, cosine};
    }
  }

  // Told by where the planes are, not by the range: a noisy one would favour one side.
  bool near_another(const RayOnPlane& ray) const {
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
      if (static_cast<int>(plane) == ray.plane) continue;
      const double apart_m = std::abs(meetings_[plane].expected_m - ray.meeting.expected_m);
      const double sum_m =
          planes_[plane].range_sigma_m + planes_[static_cast<std::size_t>(ray.plane)].range_sigma_m;
      if (apart_m < 0.5 * kAmbiguousSigmas * sum_m) return true;
    }
    return false;
  }

  const MountedBeams& beams_;
  const std::vector<SightedPlane>& planes_;
  std::vector<Vector3d> normals_;  // as the shaft stands, in the turning frame,
  std::vector<double> heights_m_;  // and the lidar's centre over the planes
  std::vector<Meeting> meetings_;  // of the ray in work
};

// A plane goes on behind edges, through whatever stands there: there only single rays meet it.
void leave_out_passing(const LineOfReadings& line, std::vector<RayOnPlane>& rays) {
  for (std::size_t first = 0; first < rays.size(); first += kRaysOfARun) {
    const std::size_t end = std::min(first + kRaysOfARun, rays.size());
    for (std::size_t beam = first; beam < end; ++beam) {
      const int plane = rays[beam].plane;
      if (plane < 0) continue;
      std::size_t said = 0;
      std::size_t same = 0;
      for (std::size_t other = first; other < end; ++other) {
        if (!std::isnan(line.ranges_m[other])) ++said;
        if (rays[other].plane == plane) ++same;
      }
      if (static_cast<double>(same) >= kLeastShareOfRun * static_cast<double>(said)) continue;
      for (std::size_t other = first; other < end; ++other) {
        if (rays[other].plane == plane) rays[other].plane = kNoPlane;
      }
    }
  }
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
  return derivative / (ray.meeting.cosine * sigma_m(plane, ray.meeting.cosine));
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
    std::vector<RayOnPlane> rays = sighter.sight(line);
    leave_out_passing(line, rays);
    for (std::size_t beam = 0; beam < rays.size(); ++beam) {
      const RayOnPlane& ray = rays[beam];
      sightings.explained[index * rays.size() + beam] = ray.plane != kNoPlane ? 1 : 0;
      if (ray.plane < 0) continue;
      const auto own = static_cast<std::size_t>(ray.plane);
      PlaneSums& sums = sightings.planes[own];
      add_ray(derivative_of(ray, planes[own], axes[own], beams, line, beam),
              ray.off_m / sigma_m(planes[own], ray.meeting.cosine),
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
