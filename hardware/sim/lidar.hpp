// The lidar's optics: a scan line is cast beam by beam, each at its own instant, from where
// the shaft is at that instant. Pure: a sweep takes as long as the arithmetic does.
//
// Beam theta leaves the lidar's centre towards (0, sin theta, cos theta) of its own frame. The
// lidar is mounted on the axis, which turns it by the shaft's angle about its Z, and the axis
// stands in the base. On Yuan's rig the centre is thus at Rz(phi) (lever arm, 0, 0), and the beam
// goes to Rz(phi) (0, sin theta, cos theta) (Yuan 2021, eqs. 4 and 5).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hardware/sim/lidar_options.hpp"
#include "hardware/sim/random.hpp"
#include "hardware/sim/spot.hpp"
#include "hardware/sim/world.hpp"

namespace swivel::sim {

struct LineInstant {
  std::uint64_t line_index = 0;    // chooses the noise, together with the seed
  std::int64_t beam0_time_ns = 0;  // beam k fires at beam0 + k * beam_period
  double beam_period_ns = 0.0;
};

// From the sensor's first step on.
struct LineReading {
  std::vector<std::uint16_t> ranges_mm;  // or the sensor's too_near, no_return
  std::vector<std::uint16_t> intensities;
};

using ShaftAngle = std::function<double(std::int64_t time_ns)>;  // rad

class Lidar {
 public:
  // `world` must outlive the lidar.
  Lidar(const LidarOptions& options, const World& world, std::uint64_t seed);

  LineReading cast_line(const LineInstant& instant, const ShaftAngle& shaft_angle) const;

  double beam_angle_rad(int step) const;  // as the sensor believes, without the bias

 private:
  Ray ray(int step, double shaft_angle_rad) const;
  double measured_mm(double distance_m, Random& random) const;
  std::uint16_t coded(double range_mm) const;

  LidarOptions options_;
  Pose axis_;
  Pose mounting_;
  Spot spot_;
  const World* world_;
  std::uint64_t seed_;
};

}  // namespace swivel::sim
