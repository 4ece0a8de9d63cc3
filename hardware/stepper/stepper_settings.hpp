// What the controller's settings say about the motion, and what a turn may be.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hardware/result.hpp"

namespace swivel {

// Angles are of the shaft, counted in GRBL's positive direction.
struct StepperSettings {
  double steps_per_deg = 0.0;        // $100
  double max_speed_deg_s = 0.0;      // $110, there in deg/min
  double acceleration_deg_s2 = 0.0;  // $120
  double travel_deg = 0.0;           // $130
  double pull_off_deg = 0.0;         // $27
  bool soft_limits = false;          // $20
  std::vector<std::string> advice;   // what works, but would be better otherwise
};

// From the values of `$$`, by number. Fails when one is missing, senseless, or makes a scan
// impossible (homing off, reports in inches).
Result<StepperSettings> read_stepper_settings(const std::map<int, double>& values);

// The rig's own limits, beside the controller's.
struct TurnLimits {
  double home_angle_deg = 0.0;         // axis angle of the home switch
  double cable_limit_deg = 330.0;      // never further than this from the home switch
  double minimum_step_rate_hz = 30.0;  // GRBL turns faster than told below this
  double max_speed_deg_s = std::numeric_limits<double>::infinity();
};

// Where the controller by itself would let the shaft go further or faster than the rig may.
std::vector<std::string> advice_on_limits(const TurnLimits& limits,
                                          const StepperSettings& settings);

// Whether the shaft may turn to the axis angle at this speed, the home switch being at machine
// position `home_machine_deg`. The reason of a refusal has the numbers.
Outcome check_turn(const TurnLimits& limits, const StepperSettings& settings,
                   double home_machine_deg, double angle_deg, double speed_deg_s);

// The angle that the controller makes of it: a whole number of steps from the home switch.
double whole_steps_deg(const TurnLimits& limits, const StepperSettings& settings, double angle_deg);

}  // namespace swivel
