#include "tests/calibration/pan_scan.hpp"

#include <cmath>
#include <limits>

#include "hardware/sim/random.hpp"

namespace swivel {
namespace {

using sim::kRadPerDeg;
using sim::Vector3;

sim::Ray ray_of(const PanScan& scan, double shaft_deg, double beam_deg) {
  const double angle_rad = (beam_deg + scan.bias_deg) * kRadPerDeg;
  Vector3 direction{0.0, std::sin(angle_rad), std::cos(angle_rad)};
  direction = sim::turned_about_x(direction, scan.rx_deg * kRadPerDeg);
  direction = sim::turned_about_y(direction, scan.ry_deg * kRadPerDeg);
  direction = sim::turned_about_z(direction, (scan.rz_deg + shaft_deg) * kRadPerDeg);
  const Vector3 centre = sim::turned_about_z(1e-3 * Vector3{scan.tx_mm, scan.ty_mm, scan.tz_mm},
                                             shaft_deg * kRadPerDeg);
  return {centre, direction};
}

double true_range_m(const PanScan& scan, const sim::World& world, const sim::Ray& ray) {
  if (!scan.roof_only) {
    const auto hit = world.cast(ray);
    return hit ? hit->distance_m : 0.0;
  }
  const double lean_rad = scan.roof_lean_deg * kRadPerDeg;
  const sim::Wall roof{{0.0, 0.0, 2.0}, {std::sin(lean_rad), 0.0, -std::cos(lean_rad)}};
  const auto hit = sim::cast(ray, roof);
  return hit ? hit->distance_m : 0.0;
}

}  // namespace

SweepReadings scan_of(const PanScan& scan) {
  sim::WorldOptions options;
  options.room = scan.room;
  options.plate.present = false;
  const sim::World world(options);
  SweepReadings readings;
  readings.first_beam_angle_rad = -135.0 * kRadPerDeg;
  readings.beam_step_rad = 0.25 * kRadPerDeg;
  for (std::size_t index = 0; index < scan.lines; ++index) {
    sim::Random random(scan.seed, index);
    const double turned_deg =
        scan.turn_deg * static_cast<double>(index) / static_cast<double>(scan.lines);
    const double said_deg = scan.start_deg + (scan.turning_down ? -turned_deg : turned_deg);
    const double shaft_deg = said_deg + scan.angle_sigma_deg * random.gaussian() +
                             (scan.turning_down ? scan.hysteresis_deg : 0.0);
    LineOfReadings line;
    line.axis_angle_rad = said_deg * kRadPerDeg;
    line.turning_down = scan.turning_down;
    for (int beam = 0; beam < 1081; ++beam) {
      const double range_m =
          true_range_m(scan, world, ray_of(scan, shaft_deg, -135.0 + 0.25 * beam));
      const double said_mm =
          std::round(1e3 * range_m + scan.range_offset_mm + scan.noise_mm * random.gaussian());
      const bool valid = range_m > 0.0 && said_mm >= 100.0 && said_mm <= 30'000.0;
      line.ranges_m.push_back(valid ? static_cast<float>(1e-3 * said_mm)
                                    : std::numeric_limits<float>::quiet_NaN());
    }
    readings.lines.push_back(std::move(line));
  }
  return readings;
}

MountingVector true_mounting(const PanScan& scan) {
  const double yaw_rad = rad_from_deg(scan.rz_deg);
  MountingVector truth = MountingVector::Zero();
  truth[kMountingBias] = rad_from_deg(scan.bias_deg - scan.rx_deg);
  truth[kMountingTilt] = rad_from_deg(scan.ry_deg);
  truth[kMountingLeverX] =
      m_from_mm(std::cos(yaw_rad) * scan.tx_mm + std::sin(yaw_rad) * scan.ty_mm);
  truth[kMountingLeverY] =
      m_from_mm(std::cos(yaw_rad) * scan.ty_mm - std::sin(yaw_rad) * scan.tx_mm);
  return truth;
}

}  // namespace swivel
