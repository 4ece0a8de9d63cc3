#include "components/stepper_sequencer/sweep_plan.hpp"

#include <string>

namespace swivel {
namespace {

// For the message that announces a window, and for rounding: a window of one line is not a
// fixed number of periods.
constexpr double kLineMarginS = 0.005;

struct Rig {
  const SweepOptions& sweep;
  const TurnLimits& limits;
  const StepperSettings& settings;

  double whole_steps(double angle_deg) const {
    return whole_steps_deg(limits, settings, angle_deg);
  }
  double longest_period_s() const {
    return sweep.line_period_s * (1.0 + sweep.line_period_tolerance);
  }
};

void plan_improved(const Rig& rig, SweepPlan& plan) {
  const double speed = plan.speed_deg_s;
  const double run_up_s = speed / rig.settings.acceleration_deg_s2;
  const double run_up_deg = 0.5 * speed * run_up_s;
  const double settle_deg = speed * rig.sweep.settle_s;
  plan.window_delay_s = run_up_s + rig.sweep.settle_s;
  plan.window_s = (plan.lines + 2) * rig.longest_period_s();
  plan.start_angle_deg = rig.whole_steps(-(run_up_deg + settle_deg));
  plan.window_angle_deg = plan.start_angle_deg + run_up_deg + settle_deg;
  const double window_end_deg = plan.window_angle_deg + speed * plan.window_s;
  plan.end_angle_deg = rig.whole_steps(window_end_deg + settle_deg + run_up_deg);
  plan.steady_start_deg = plan.start_angle_deg + run_up_deg;
  plan.steady_end_deg = plan.end_angle_deg - run_up_deg;
}

// As if the motor had no mass: it turns the sweep's angle, and the lines count from the start.
void plan_naive(const Rig& rig, SweepPlan& plan) {
  plan.window_s = (plan.lines + 2) * rig.longest_period_s();
  plan.start_angle_deg = rig.whole_steps(0.0);
  plan.window_angle_deg = plan.start_angle_deg;
  plan.end_angle_deg = rig.whole_steps(rig.sweep.sweep_angle_deg);
}

// It starts one step early, so that every line is come to from the same side.
void plan_stop_and_go(const Rig& rig, SweepPlan& plan) {
  const double gamma_deg = rig.sweep.sweep_angle_deg / plan.lines;
  plan.window_s = 2.0 * rig.longest_period_s() + kLineMarginS;
  plan.start_angle_deg = rig.whole_steps(-gamma_deg);
  for (std::uint32_t line = 0; line < plan.lines; ++line)
    plan.line_angles_deg.push_back(rig.whole_steps(line * gamma_deg));
  plan.end_angle_deg = plan.line_angles_deg.back();
}

std::string known_modes(const SweepOptions& options) {
  std::string modes;
  for (const auto& [mode, lines] : options.lines_of_mode) modes += " " + std::to_string(mode);
  return modes;
}

}  // namespace

Result<SweepPlan> plan_sweep(const SweepOptions& options, const TurnLimits& limits,
                             const StepperSettings& settings, int mode,
                             msg::SweepSequence sequence) {
  const auto entry = options.lines_of_mode.find(mode);
  if (entry == options.lines_of_mode.end() || entry->second == 0) {
    return Failure{"there is no mode " + std::to_string(mode) + "; this rig has" +
                   known_modes(options)};
  }
  SweepPlan plan;
  plan.mode = mode;
  plan.sequence = sequence;
  plan.lines = entry->second;
  plan.speed_deg_s = options.sweep_angle_deg / (plan.lines * options.line_period_s);
  const Rig rig{options, limits, settings};
  switch (sequence) {
    case msg::SEQUENCE_IMPROVED:
      return plan_improved(rig, plan), plan;
    case msg::SEQUENCE_NAIVE:
      return plan_naive(rig, plan), plan;
    case msg::SEQUENCE_STOP_AND_GO:
      return plan_stop_and_go(rig, plan), plan;
  }
  return Failure{"there is no action sequence " + std::to_string(static_cast<int>(sequence))};
}

}  // namespace swivel
