// From the motor's steps to the true azimuth of the scan plane's normal in frame O: what a
// controller without an encoder cannot know.
#pragma once

#include <cmath>

#include "hardware/sim/vector3.hpp"

namespace swivel::sim {

struct ShaftOptions {
  // A motor of 200 full steps, 1/16 steps, a 10:1 gear: 88.889 steps a degree. A line of mode
  // 7 (0.28125 deg) is then 25 steps, and those of modes 1 to 6 are whole numbers too.
  double steps_per_turn = 32000.0;
  double power_up_angle_deg = -60.0;  // where the shaft stands when the bench starts
  double ripple_deg = 0.0;            // amplitude of the motor's error within a period
  double ripple_period_deg = 0.72;    // of the shaft: four full steps of the motor
};

inline double shaft_angle_deg(const ShaftOptions& options, double motor_steps) {
  const double turned_deg = motor_steps * 360.0 / options.steps_per_turn;
  const double ripple = std::sin(turned_deg / options.ripple_period_deg * 360.0 * kRadPerDeg);
  return options.power_up_angle_deg + turned_deg + options.ripple_deg * ripple;
}

// The inverse, ripple left out.
inline double motor_steps(const ShaftOptions& options, double angle_deg) {
  return (angle_deg - options.power_up_angle_deg) * options.steps_per_turn / 360.0;
}

}  // namespace swivel::sim
