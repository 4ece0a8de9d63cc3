#include "hardware/sim/lidar.hpp"

#include <algorithm>
#include <cmath>

namespace swivel::sim {
namespace {

constexpr double kFadingLengthM = 0.3;
constexpr double kWeakest = 20.0;  // an echo that the sensor still sees

}  // namespace

Lidar::Lidar(const LidarOptions& options, const World& world, std::uint64_t seed)
    : options_(options),
      axis_(options.axis),
      mounting_(options.mounting),
      spot_(options),
      world_(&world),
      seed_(seed) {}

double Lidar::beam_angle_rad(int step) const {
  return (step - options_.sensor.front_step) * 360.0 / options_.sensor.steps_per_turn * kRadPerDeg;
}

Ray Lidar::ray(int step, double shaft_angle_rad) const {
  const double theta = beam_angle_rad(step) + options_.bias_deg * kRadPerDeg;
  const Vector3 beam{0.0, std::sin(theta), std::cos(theta)};
  const Vector3 centre = turned_about_z(mounting_.point({}), shaft_angle_rad);
  const Vector3 towards = turned_about_z(mounting_.direction(beam), shaft_angle_rad);
  return {axis_.point(centre), axis_.direction(towards)};
}

std::uint16_t Lidar::coded(double range_mm) const {
  if (range_mm > options_.sensor.farthest_mm) return options_.sensor.no_return;
  if (range_mm < options_.sensor.nearest_mm) return options_.sensor.too_near;
  return static_cast<std::uint16_t>(std::lround(range_mm));
}

double Lidar::measured_mm(double distance_m, Random& random) const {
  return distance_m * 1e3 + options_.range_bias_mm +
         options_.near_bias_mm * std::exp(-distance_m / kFadingLengthM) +
         options_.noise_mm * random.gaussian();
}

LineReading Lidar::cast_line(const LineInstant& instant, const ShaftAngle& shaft_angle) const {
  Random random(seed_, instant.line_index);
  LineReading line;
  const SensorModel& sensor = options_.sensor;
  const auto beams = static_cast<std::size_t>(sensor.last_step - sensor.first_step + 1);
  line.ranges_mm.reserve(beams);
  line.intensities.reserve(beams);
  for (int step = sensor.first_step; step <= sensor.last_step; ++step) {
    const double delay_ns = (step - sensor.first_step) * instant.beam_period_ns;
    const auto time_ns = instant.beam0_time_ns + std::llround(delay_ns);
    const auto echo = spot_.echo(*world_, ray(step, shaft_angle(time_ns)), random);
    const bool seen =
        echo && echo->strength >= kWeakest && random.uniform() >= options_.dropout_rate;
    const double strength = seen ? echo->strength * (1.0 + 0.03 * random.gaussian()) : 0.0;
    line.ranges_mm.push_back(seen ? coded(measured_mm(echo->distance_m, random))
                                  : sensor.no_return);
    line.intensities.push_back(static_cast<std::uint16_t>(std::clamp(strength, 0.0, 60000.0)));
  }
  return line;
}

}  // namespace swivel::sim
