#include "hardware/sim/lidar.hpp"

#include <algorithm>
#include <cmath>

namespace swivel::sim {
namespace {

constexpr double kFadingLengthM = 0.3;
constexpr double kWeakest = 20.0;  // an echo that the sensor still sees

std::uint16_t coded(double range_mm) {
  if (range_mm > 30000.0) return kNoReturn;
  if (range_mm < 21.0) return kTooNear;
  return static_cast<std::uint16_t>(std::lround(range_mm));
}

}  // namespace

Lidar::Lidar(const LidarOptions& options, const World& world, std::uint64_t seed)
    : options_(options), spot_(options), world_(&world), seed_(seed) {}

double Lidar::beam_angle_rad(int step) const {
  return (step - options_.front_step) * 360.0 / options_.steps_per_turn * kRadPerDeg;
}

Ray Lidar::ray(int step, double shaft_angle_rad) const {
  const double theta = beam_angle_rad(step) + options_.bias_deg * kRadPerDeg;
  const double c = std::cos(shaft_angle_rad);
  const double s = std::sin(shaft_angle_rad);
  const double lever_arm_m = options_.lever_arm_mm * 1e-3;
  const double level = std::sin(theta);
  return {{lever_arm_m * c, lever_arm_m * s, 0.0}, {-s * level, c * level, std::cos(theta)}};
}

double Lidar::measured_mm(double distance_m, Random& random) const {
  return distance_m * 1e3 + options_.range_bias_mm +
         options_.near_bias_mm * std::exp(-distance_m / kFadingLengthM) +
         options_.noise_mm * random.gaussian();
}

LineReading Lidar::cast_line(const LineInstant& instant, const ShaftAngle& shaft_angle) const {
  Random random(seed_, instant.line_index);
  LineReading line;
  line.ranges_mm.reserve(static_cast<std::size_t>(options_.last_step) + 1);
  line.intensities.reserve(static_cast<std::size_t>(options_.last_step) + 1);
  for (int step = 0; step <= options_.last_step; ++step) {
    const auto time_ns = instant.beam0_time_ns + std::llround(step * instant.beam_period_ns);
    const auto echo = spot_.echo(*world_, ray(step, shaft_angle(time_ns)), random);
    const bool seen =
        echo && echo->strength >= kWeakest && random.uniform() >= options_.dropout_rate;
    const double strength = seen ? echo->strength * (1.0 + 0.03 * random.gaussian()) : 0.0;
    line.ranges_mm.push_back(seen ? coded(measured_mm(echo->distance_m, random)) : kNoReturn);
    line.intensities.push_back(static_cast<std::uint16_t>(std::clamp(strength, 0.0, 60000.0)));
  }
  return line;
}

}  // namespace swivel::sim
