#include "hardware/sim/lidar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace swivel::sim {
namespace {

constexpr double kFadingLengthM = 0.3;
constexpr double kEdgeM = 0.05;      // a step within the spot that makes an edge of it
constexpr double kWeakest = 20.0;    // an echo that the sensor still sees
constexpr double kBrightest = 4500;  // white, square, at arm's length
constexpr double kHalfwayM = 4.0;    // where an echo is half as strong

double strength_of(const Hit& hit) {
  const double distance = hit.distance_m / kHalfwayM;
  return kBrightest * hit.reflectivity * hit.cos_incidence / (1.0 + distance * distance);
}

std::uint16_t coded(double range_mm) {
  if (range_mm > 30000.0) return kNoReturn;
  if (range_mm < 21.0) return kTooNear;
  return static_cast<std::uint16_t>(std::lround(range_mm));
}

// The centre of the spot and four points at its half-power radius.
std::array<Ray, 5> rays_of_spot(const Ray& ray, double radius_m) {
  const Vector3 reference =
      std::abs(ray.direction.z) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
  const Vector3 raw = cross(ray.direction, reference);
  const Vector3 side = radius_m / std::sqrt(dot(raw, raw)) * raw;
  const Vector3 up = cross(side, ray.direction);
  return {ray, Ray{ray.origin + side, ray.direction}, Ray{ray.origin - side, ray.direction},
          Ray{ray.origin + up, ray.direction}, Ray{ray.origin - up, ray.direction}};
}

}  // namespace

Lidar::Lidar(const LidarOptions& options, const World& world, std::uint64_t seed)
    : options_(options), world_(&world), seed_(seed) {}

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

// A spot on an edge answers one of its sides, each as often as it covers of the spot, or now
// and then something in between: a mixed pixel.
std::optional<Lidar::Echo> Lidar::echo_of_spot(const Ray& ray, Random& random) const {
  if (options_.spot_radius_mm <= 0.0) {
    const auto hit = world_->cast(ray);
    return hit ? std::optional<Echo>({hit->distance_m, strength_of(*hit)}) : std::nullopt;
  }
  std::vector<Echo> echoes;
  for (const Ray& part : rays_of_spot(ray, options_.spot_radius_mm * 1e-3)) {
    if (const auto hit = world_->cast(part)) echoes.push_back({hit->distance_m, strength_of(*hit)});
  }
  if (echoes.empty()) return std::nullopt;
  const auto [nearest, farthest] =
      std::minmax_element(echoes.begin(), echoes.end(),
                          [](const Echo& a, const Echo& b) { return a.distance_m < b.distance_m; });
  const double step_m = farthest->distance_m - nearest->distance_m;
  if (step_m > kEdgeM && random.uniform() < options_.mixed_pixel_rate) {
    return Echo{nearest->distance_m + random.uniform() * step_m, nearest->strength};
  }
  return echoes[static_cast<std::size_t>(random.uniform() * static_cast<double>(echoes.size()))];
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
    const auto echo = echo_of_spot(ray(step, shaft_angle(time_ns)), random);
    const bool seen =
        echo && echo->strength >= kWeakest && random.uniform() >= options_.dropout_rate;
    const double strength = seen ? echo->strength * (1.0 + 0.03 * random.gaussian()) : 0.0;
    line.ranges_mm.push_back(seen ? coded(measured_mm(echo->distance_m, random)) : kNoReturn);
    line.intensities.push_back(static_cast<std::uint16_t>(std::clamp(strength, 0.0, 60000.0)));
  }
  return line;
}

}  // namespace swivel::sim
