#include "calibration/plate_beams.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace swivel {
namespace {

constexpr double kLeastDescent = 0.2;    // of a beam towards the plate, per length
constexpr std::size_t kScoutLines = 64;  // that tell which columns look at the ring
constexpr std::size_t kSpareColumns = 4;

// What following a beam back to the lidar's centre needs of the rig.
class BeamTracer {
 public:
  BeamTracer(const PlateGeometry& plate, const RigGeometry& rig)
      : plate_(plate),
        normal_(rig.T_axis_lidar.linear().col(0)),
        lever_arm_m_(rig.T_axis_lidar.translation()),
        height_m_(plate_height_m(plate, rig)),
        reach_m_(lever_arm_m_.head<2>().norm()) {}

  std::optional<PlateBeam> trace(const CloudPoint& point) const;

 private:
  bool passes_over(const Eigen::Vector3d& p) const;
  std::optional<Eigen::Vector3d> centre_of(const Eigen::Vector3d& p) const;

  PlateGeometry plate_;
  Eigen::Vector3d normal_;  // of the scan plane, in the axis frame
  Eigen::Vector3d lever_arm_m_;
  double height_m_;
  double reach_m_;
};

// A quick way out for most beams: those too level to come down inside the ring, wherever the
// lidar's centre was on its circle.
bool BeamTracer::passes_over(const Eigen::Vector3d& p) const {
  const double down_m = lever_arm_m_.z() - p.z();
  const double most_level_m = (plate_.ring_outer_m + reach_m_) * down_m / plate_.depth_m + reach_m_;
  return down_m <= 0.0 || p.head<2>().squaredNorm() > most_level_m * most_level_m;
}

// The lidar's centre at the instant of the beam: the axis angle a is that for which the point lies
// in the scan plane, normal . (Rz(-a) p - lever arm) = 0, and on the plate's side of the fan.
std::optional<Eigen::Vector3d> BeamTracer::centre_of(const Eigen::Vector3d& p) const {
  const double along = normal_.x() * p.x() + normal_.y() * p.y();
  const double across = normal_.x() * p.y() - normal_.y() * p.x();
  const double wanted = normal_.dot(lever_arm_m_) - normal_.z() * p.z();
  const double squares = along * along + across * across;
  const double rest = squares - wanted * wanted;
  if (rest <= 0.0) return std::nullopt;
  const double other = std::sqrt(rest);
  const double cos_a = (along * wanted - across * other) / squares;
  const double sin_a = (across * wanted + along * other) / squares;
  return Eigen::Vector3d(cos_a * lever_arm_m_.x() - sin_a * lever_arm_m_.y(),
                         sin_a * lever_arm_m_.x() + cos_a * lever_arm_m_.y(), lever_arm_m_.z());
}

std::optional<PlateBeam> BeamTracer::trace(const CloudPoint& point) const {
  if (!point.valid() || point.x_m <= 0.0F) return std::nullopt;
  const Eigen::Vector3d p = Eigen::Vector3f(point.x_m, point.y_m, point.z_m).cast<double>();
  if (passes_over(p)) return std::nullopt;
  const auto centre = centre_of(p);
  if (!centre) return std::nullopt;
  const Eigen::Vector3d along = p - *centre;
  const double range_m = along.norm();
  if (along.z() >= -kLeastDescent * range_m) return std::nullopt;
  const double part = (height_m_ - centre->z()) / along.z();
  const Eigen::Vector3d met = *centre + part * along;
  const double square = met.head<2>().squaredNorm();
  if (met.x() <= 0.0 || square < plate_.ring_inner_m * plate_.ring_inner_m ||
      square > plate_.ring_outer_m * plate_.ring_outer_m)
    return std::nullopt;
  return PlateBeam{met.x(),
                   met.y(),
                   along.x() / along.z(),
                   along.y() / along.z(),
                   std::atan2(met.y(), met.x()),
                   range_m * (1.0 - part),
                   0,
                   in_ring(point, plate_, height_m_)};
}

// The same beams of the fan look at the ring in every line: some at either end of it.
std::vector<std::size_t> columns_at_plate(const OrganisedCloud& cloud, const BeamTracer& tracer) {
  std::vector<bool> looks(cloud.beams, false);
  const std::size_t stride = 1 + cloud.lines / kScoutLines;
  for (std::size_t line = 0; line < cloud.lines; line += stride) {
    for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
      if (!looks[beam]) looks[beam] = tracer.trace(cloud.line(line)[beam]).has_value();
    }
  }
  std::vector<std::size_t> columns;
  for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
    const auto first =
        looks.begin() + static_cast<std::ptrdiff_t>(beam - std::min(beam, kSpareColumns));
    const auto end = looks.begin() +
                     static_cast<std::ptrdiff_t>(std::min(beam + kSpareColumns + 1, cloud.beams));
    if (std::find(first, end, true) != end) columns.push_back(beam);
  }
  return columns;
}

}  // namespace

bool in_ring(const CloudPoint& point, const PlateGeometry& plate, double height_m) {
  if (!(std::abs(static_cast<double>(point.z_m) - height_m) <= plate.ring_thickness_m / 2))
    return false;
  const auto x_m = static_cast<double>(point.x_m);
  const auto y_m = static_cast<double>(point.y_m);
  const double square = x_m * x_m + y_m * y_m;
  return x_m > 0.0 && square >= plate.ring_inner_m * plate.ring_inner_m &&
         square <= plate.ring_outer_m * plate.ring_outer_m;
}

double plate_height_m(const PlateGeometry& plate, const RigGeometry& rig) {
  return rig.T_axis_lidar.translation().z() - plate.depth_m;
}

std::vector<PlateBeam> beams_at_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                      const RigGeometry& rig) {
  const BeamTracer tracer(plate, rig);
  const std::vector<std::size_t> columns = columns_at_plate(cloud, tracer);
  std::vector<PlateBeam> beams;
  beams.reserve(cloud.lines * columns.size());
  for (std::size_t line = 0; line < cloud.lines; ++line) {
    for (const std::size_t beam : columns) {
      auto met = tracer.trace(cloud.line(line)[beam]);
      if (!met) continue;
      met->line = static_cast<std::uint32_t>(line);
      beams.push_back(*met);
    }
  }
  return beams;
}

}  // namespace swivel
