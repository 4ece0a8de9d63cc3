#include "hardware/stepper/stepper_settings.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace swivel {
namespace {

std::string text(double value) {
  std::array<char, 32> characters{};
  std::snprintf(characters.data(), characters.size(), "%.6g", value);
  return characters.data();
}

struct NeededSetting {
  int number;
  const char* meaning;
  double lowest;
  double highest;
};
constexpr std::array<NeededSetting, 7> kNeeded{{
    {100, "steps per degree", 1e-3, 1e6},
    {110, "the highest speed in deg/min", 1e-3, 1e9},
    {120, "the acceleration in deg/s^2", 1e-3, 1e9},
    {130, "the travel in deg", 1e-3, 1e6},
    {27, "the pull-off from the home switch in deg", 0.0, 360.0},
    {22, "homing on (1)", 1.0, 1.0},
    {13, "reports in inches off (0)", 0.0, 0.0},
}};

std::string name_of(const NeededSetting& needed) {
  return "$" + std::to_string(needed.number);
}

Failure missing(const NeededSetting& needed) {
  return {"the controller has no setting " + name_of(needed) + " (" + needed.meaning +
          "); is it GRBL 1.1?"};
}

Failure senseless(const NeededSetting& needed, double value) {
  return {"the controller has " + name_of(needed) + "=" + text(value) + ", which is to be " +
          needed.meaning + "; set it and try again"};
}

Outcome check_needed(const std::map<int, double>& values) {
  for (const NeededSetting& needed : kNeeded) {
    const auto found = values.find(needed.number);
    if (found == values.end()) return missing(needed);
    const bool sensible = found->second >= needed.lowest && found->second <= needed.highest;
    if (!sensible) return senseless(needed, found->second);
  }
  return Done{};
}

bool is_off(const std::map<int, double>& values, int number) {
  const auto found = values.find(number);
  return found == values.end() || found->second == 0.0;
}

std::vector<std::string> advice_on(const std::map<int, double>& values) {
  std::vector<std::string> advice;
  if (is_off(values, 20)) {
    advice.emplace_back(
        "soft limits are off: with $20=1 and $130 as long as the cable the controller guards it "
        "too");
  }
  const auto hold = values.find(1);
  if (hold != values.end() && hold->second < 255.0) {
    advice.push_back("the motor is let go " + text(hold->second) +
                     " ms after each turn and may slip; $1=255 holds it");
  }
  return advice;
}

// GRBL takes float from text: a speed right at the limit is not beyond it.
bool is_beyond(double speed_deg_s, double limit_deg_s) {
  return !(speed_deg_s <= limit_deg_s * (1.0 + 1e-6));
}

Outcome check_speed(const TurnLimits& limits, const StepperSettings& settings, double speed_deg_s) {
  const double step_rate_hz = settings.steps_per_deg * speed_deg_s;
  if (!(step_rate_hz >= limits.minimum_step_rate_hz)) {
    return Failure{text(speed_deg_s) + " deg/s is " + text(step_rate_hz) +
                   " steps/s ($100=" + text(settings.steps_per_deg) +
                   " steps/deg), but the controller holds no rate below " +
                   text(limits.minimum_step_rate_hz) + " steps/s; take " +
                   text(limits.minimum_step_rate_hz / settings.steps_per_deg) +
                   " deg/s or more, or a finer microstep"};
  }
  if (is_beyond(speed_deg_s, limits.max_speed_deg_s)) {
    return Failure{text(speed_deg_s) + " deg/s is beyond the rig's " +
                   text(limits.max_speed_deg_s) + " deg/s (max_speed_deg_s)"};
  }
  if (is_beyond(speed_deg_s, settings.max_speed_deg_s)) {
    return Failure{text(speed_deg_s) + " deg/s is beyond the controller's " +
                   text(settings.max_speed_deg_s) +
                   " deg/s ($110=" + text(settings.max_speed_deg_s * 60.0) +
                   " deg/min); raise $110 if the motor can follow"};
  }
  return Done{};
}

}  // namespace

Result<StepperSettings> read_stepper_settings(const std::map<int, double>& values) {
  const Outcome needed = check_needed(values);
  if (!needed) return Failure{needed.reason()};
  StepperSettings settings;
  settings.steps_per_deg = values.at(100);
  settings.max_speed_deg_s = values.at(110) / 60.0;
  settings.acceleration_deg_s2 = values.at(120);
  settings.travel_deg = values.at(130);
  settings.pull_off_deg = values.at(27);
  settings.soft_limits = !is_off(values, 20);
  settings.advice = advice_on(values);
  return settings;
}

std::vector<std::string> advice_on_limits(const TurnLimits& limits,
                                          const StepperSettings& settings) {
  std::vector<std::string> advice;
  const double reach_deg = settings.travel_deg - settings.pull_off_deg;
  if (settings.soft_limits && reach_deg > limits.cable_limit_deg + 0.5 / settings.steps_per_deg) {
    advice.push_back("the controller lets the shaft turn " + text(reach_deg) +
                     " deg from the home switch, the cable only " + text(limits.cable_limit_deg) +
                     " deg: with $130=" + text(limits.cable_limit_deg + settings.pull_off_deg) +
                     " it guards the cable too");
  }
  if (is_beyond(settings.max_speed_deg_s, limits.max_speed_deg_s)) {
    advice.push_back("the controller turns up to " + text(settings.max_speed_deg_s) +
                     " deg/s, the rig may up to " + text(limits.max_speed_deg_s) +
                     " deg/s: send $110=" + text(limits.max_speed_deg_s * 60.0));
  }
  return advice;
}

Outcome check_turn(const TurnLimits& limits, const StepperSettings& settings,
                   double home_machine_deg, double angle_deg, double speed_deg_s) {
  Outcome speed = check_speed(limits, settings, speed_deg_s);
  if (!speed) return speed;
  const double half_step_deg = 0.5 / settings.steps_per_deg;
  const double from_home_deg = angle_deg - limits.home_angle_deg;
  const bool cable_holds =
      from_home_deg >= -half_step_deg && from_home_deg <= limits.cable_limit_deg;
  if (!cable_holds) {
    return Failure{"a turn to " + text(angle_deg) + " deg is " + text(from_home_deg) +
                   " deg from the home switch, but the cable allows 0 to " +
                   text(limits.cable_limit_deg) + " deg"};
  }
  const double machine_deg = home_machine_deg + from_home_deg;
  const bool within_travel = machine_deg >= -settings.travel_deg && machine_deg <= half_step_deg;
  if (!within_travel) {
    return Failure{"a turn to " + text(angle_deg) + " deg is machine position " +
                   text(machine_deg) + ", beyond the controller's travel of " +
                   text(-settings.travel_deg) +
                   " to 0 ($130); raise $130, or turn the homing direction ($23) round"};
  }
  return Done{};
}

double whole_steps_deg(const TurnLimits& limits, const StepperSettings& settings,
                       double angle_deg) {
  const double steps = (angle_deg - limits.home_angle_deg) * settings.steps_per_deg;
  return limits.home_angle_deg + std::round(steps) / settings.steps_per_deg;
}

}  // namespace swivel
