// The lidar's optics: a scan line is cast beam by beam, each at its own instant, from where
// the shaft is at that instant. Pure: a sweep takes as long as the arithmetic does.
//
// Frame O, shaft at azimuth phi (of the scan plane's normal, counter-clockwise from above):
// the lidar's centre is at Rz(phi) (lever_arm, 0, 0), and beam theta leaves it towards
// Rz(phi) (0, sin theta, cos theta) (Yuan 2021, eqs. 4 and 5).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hardware/sim/lidar_options.hpp"
#include "hardware/sim/random.hpp"
#include "hardware/sim/spot.hpp"
#include "hardware/sim/world.hpp"

namespace swivel::sim {

inline constexpr std::uint16_t kTooNear = 4;       // what the sensor says below 21 mm
inline constexpr std::uint16_t kNoReturn = 65533;  // and beyond 30 m, or of a weak echo

struct LineInstant {
  std::uint64_t line_index = 0;    // chooses the noise, together with the seed
  std::int64_t beam0_time_ns = 0;  // beam k fires at beam0 + k * beam_period
  double beam_period_ns = 0.0;
};

struct LineReading {
  std::vector<std::uint16_t> ranges_mm;  // or kTooNear, kNoReturn
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

  LidarOptions options_;
  Spot spot_;
  const World* world_;
  std::uint64_t seed_;
};

}  // namespace swivel::sim
