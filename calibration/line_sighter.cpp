#include "calibration/line_sighter.hpp"

#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

constexpr double kGateSigmas = 3.5;       // of a range from the plane's, to be of that plane
constexpr double kAmbiguousSigmas = 8.0;  // two planes as near to one another could both be meant
constexpr double kGrazing = 0.26;         // cosine: 75 deg; rays that graze see edges and paint
constexpr double kGrazingTangent = 5.0;   // at which a range's variance is twice what it is
constexpr std::size_t kRaysOfARun = 16;
constexpr double kLeastShareOfRun = 0.7;  // fewer rays on the plane only pass through it

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
        if (rays[other].plane == plane) rays[other].plane = RayOnPlane::kNoPlane;
      }
    }
  }
}

}  // namespace

double range_sigma_m(const SightedPlane& plane, double cosine) {
  const double tangent_squared = 1.0 / (cosine * cosine) - 1.0;
  return plane.range_sigma_m *
         std::sqrt(1.0 + tangent_squared / (kGrazingTangent * kGrazingTangent));
}

LineSighter::LineSighter(const MountedBeams& beams, const std::vector<SightedPlane>& planes)
    : beams_(beams),
      planes_(planes),
      normals_(planes.size()),
      heights_m_(planes.size()),
      meetings_(planes.size()) {}

std::vector<RayOnPlane> LineSighter::sight(const LineOfReadings& line) {
  std::vector<RayOnPlane> rays(line.ranges_m.size());
  turn(beams_.shaft_at(line, 0));
  for (std::size_t beam = 0; beam < rays.size(); ++beam) {
    if (std::isnan(line.ranges_m[beam])) continue;
    if (line.angle_per_beam_rad != 0.0) turn(beams_.shaft_at(line, beam));
    rays[beam] = sight(beam, static_cast<double>(line.ranges_m[beam]));
  }
  leave_out_passing(line, rays);
  return rays;
}

void LineSighter::turn(const ShaftTurn& shaft) {
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    normals_[plane] = shaft.to_turning(planes_[plane].normal);
    heights_m_[plane] = planes_[plane].distance_m + normals_[plane].dot(beams_.lever_arm_m());
  }
}

RayOnPlane LineSighter::sight(std::size_t beam, double range_m) {
  meet_all(beam);
  RayOnPlane ray;
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    const Meeting& meeting = meetings_[plane];
    const double off_m = range_m - meeting.expected_m;
    if (!(std::abs(meeting.cosine) > kGrazing) || meeting.expected_m < 0.0) continue;
    if (std::abs(off_m) > kGateSigmas * range_sigma_m(planes_[plane], meeting.cosine)) continue;
    if (ray.plane != RayOnPlane::kNoPlane && std::abs(off_m) > std::abs(ray.off_m)) continue;
    ray = {static_cast<int>(plane), meeting, off_m};
  }
  if (ray.plane != RayOnPlane::kNoPlane && near_another(ray)) ray.plane = RayOnPlane::kTwoPlanes;
  return ray;
}

void LineSighter::meet_all(std::size_t beam) {
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    const double cosine = normals_[plane].dot(beams_.direction(beam));
    meetings_[plane] = {beams_.range_offset_m() - heights_m_[plane] / cosine, cosine};
  }
}

// Told by where the planes are, not by the range: a noisy one would favour one side.
bool LineSighter::near_another(const RayOnPlane& ray) const {
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    if (static_cast<int>(plane) == ray.plane) continue;
    const double apart_m = std::abs(meetings_[plane].expected_m - ray.meeting.expected_m);
    const double sum_m =
        planes_[plane].range_sigma_m + planes_[static_cast<std::size_t>(ray.plane)].range_sigma_m;
    if (apart_m < 0.5 * kAmbiguousSigmas * sum_m) return true;
  }
  return false;
}

}  // namespace swivel
