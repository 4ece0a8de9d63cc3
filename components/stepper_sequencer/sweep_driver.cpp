#include "components/stepper_sequencer/sweep_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kArrivalPollNs = 20'000'000;
// From the controller's ok to its first step, at most; it is Idle until then.
constexpr std::int64_t kStartGraceNs = 250'000'000;
constexpr double kOverdueS = 2.0;
// A measured shaft stands where the motor took it, and that is not a whole step of its encoder;
// what is further off has lost steps.
constexpr double kMeasuredTolerance_deg = 0.5;

std::int64_t after(std::int64_t time_ns, double seconds) {
  return time_ns + std::llround(seconds * 1e9);
}

// Reports round to 1 deg/min; the controller's clock may be off by a little.
bool is_speed(double reported_deg_s, double speed_deg_s) {
  return std::abs(reported_deg_s - speed_deg_s) <= 0.01 * speed_deg_s + 2.0 / 60.0;
}

bool is_steady(const SweepPlan& plan, const StepperStatus& status) {
  return status.state == GrblState::kJog && is_speed(status.speed_deg_s, plan.speed_deg_s);
}

// One report at full speed tells how long the speed has been and will be constant; the
// instant of the report is known to lie between question and answer.
bool proves(const SweepPlan& plan, const StepperStatus& status, const LineWindow& window) {
  if (!is_steady(plan, status)) return false;
  const double since_s = (status.angle_deg - plan.steady_start_deg) / plan.speed_deg_s;
  const double left_s = (plan.steady_end_deg - status.angle_deg) / plan.speed_deg_s;
  return after(status.answered_ns, -since_s) <= window.start_ns &&
         window.end_ns <= after(status.asked_ns, left_s);
}

std::string what_it_does(const StepperStatus& status) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "the controller says %s, %.2f deg/s, at %.2f deg",
                grbl_state_name(status.state), status.speed_deg_s, status.angle_deg);
  return text.data();
}

LineWindow window_from(const SweepPlan& plan, std::int64_t start_ns) {
  LineWindow window;
  window.start_ns = start_ns;
  window.end_ns = after(start_ns, plan.window_s);
  window.start_deg = plan.window_angle_deg;
  window.end_deg = plan.window_angle_deg + plan.speed_deg_s * plan.window_s;
  window.lines = plan.lines;
  return window;
}

// When the shaft is where the window opens, by one reported angle at full speed: however late the
// motor started, or its ok was read.
std::int64_t opens_ns(const SweepPlan& plan, const StepperStatus& status) {
  const std::int64_t middle_ns = status.asked_ns + (status.answered_ns - status.asked_ns) / 2;
  return after(middle_ns, (plan.window_angle_deg - status.angle_deg) / plan.speed_deg_s);
}

}  // namespace

SweepDriver::SweepDriver(GrblStepper& stepper, const SweepOptions& options, double poll_interval_s,
                         Announcer& announcer, const Interruption& interruption,
                         Heartbeat& heartbeat)
    : stepper_(stepper),
      options_(options),
      poll_interval_ns_(after(0, poll_interval_s)),
      announcer_(announcer),
      interruption_(interruption),
      heartbeat_(heartbeat) {}

Outcome SweepDriver::check(const SweepPlan& plan) const {
  const bool turns_through = plan.sequence != msg::SEQUENCE_STOP_AND_GO;
  const double speed_deg_s = turns_through ? plan.speed_deg_s : options_.return_speed_deg_s;
  Outcome start = stepper_.check_move(plan.start_angle_deg, options_.return_speed_deg_s);
  if (!start) return start;
  return stepper_.check_move(plan.end_angle_deg, speed_deg_s);
}

Outcome SweepDriver::go_to(double angle_deg) {
  const Result<StepperStatus> before = look();
  if (!before) return Failure{before.reason()};
  const Result<Turn> turn = stepper_.move_to(angle_deg, options_.return_speed_deg_s);
  if (!turn) return Failure{turn.reason()};
  return arrive(*turn, options_.return_speed_deg_s);
}

Outcome SweepDriver::sweep(const SweepPlan& plan) {
  announcer_.phase(msg::PHASE_ACCELERATING);
  if (plan.sequence == msg::SEQUENCE_NAIVE) return sweep_naive(plan);
  if (plan.sequence == msg::SEQUENCE_STOP_AND_GO) return sweep_stop_and_go(plan);
  return sweep_improved(plan);
}

Outcome SweepDriver::sweep_improved(const SweepPlan& plan) {
  const Result<Turn> turn = stepper_.move_to(plan.end_angle_deg, plan.speed_deg_s);
  if (!turn) return Failure{turn.reason()};
  LineWindow window = window_from(plan, after(turn->accepted_ns, plan.window_delay_s));
  Outcome steady = confirm_window(plan, *turn, window);
  if (!steady) return steady;
  announcer_.window(window);
  Outcome held = watch_window(plan, window);
  if (!held) return held;
  announcer_.phase(msg::PHASE_DECELERATING);
  return arrive(*turn, plan.speed_deg_s);
}

Outcome SweepDriver::confirm_window(const SweepPlan& plan, const Turn& turn, LineWindow& window) {
  const std::int64_t interval_ns = std::clamp<std::int64_t>(after(0, options_.settle_s / 4.0),
                                                            kArrivalPollNs, poll_interval_ns_);
  for (;;) {
    const Result<StepperStatus> status = look();
    if (!status) return Failure{status.reason()};
    // A commanded turn is counted from its ok, unless that was read too late, or too early.
    const bool by_report = options_.axis_measured || !proves(plan, *status, window);
    if (by_report && is_steady(plan, *status)) window = window_from(plan, opens_ns(plan, *status));
    if (proves(plan, *status, window)) return Done{};
    const bool should_turn = status->asked_ns > turn.accepted_ns + kStartGraceNs;
    if (should_turn && status->state != GrblState::kJog)
      return Failure{"the turn ended early: " + what_it_does(*status)};
    if (status->asked_ns > window.end_ns)
      return Failure{"the speed was not constant in time: " + what_it_does(*status)};
    Outcome paused = pause_until(now_ns() + interval_ns);
    if (!paused) return paused;
  }
}

Outcome SweepDriver::watch_window(const SweepPlan& plan, const LineWindow& window) {
  while (now_ns() < window.end_ns) {
    Outcome paused = pause_until(std::min(now_ns() + poll_interval_ns_, window.end_ns));
    if (!paused) return paused;
    const Result<StepperStatus> status = look();
    if (!status) return Failure{status.reason()};
    const bool within = status->answered_ns <= window.end_ns;
    if (plan.sequence == msg::SEQUENCE_IMPROVED && within && !is_steady(plan, *status))
      return Failure{"the speed changed within the sweep: " + what_it_does(*status)};
  }
  return Done{};
}

Outcome SweepDriver::sweep_naive(const SweepPlan& plan) {
  const Result<Turn> turn = stepper_.move_to(plan.end_angle_deg, plan.speed_deg_s);
  if (!turn) return Failure{turn.reason()};
  const LineWindow window = window_from(plan, turn->sent_ns);
  announcer_.window(window);
  Outcome watched = watch_window(plan, window);
  if (!watched) return watched;
  announcer_.phase(msg::PHASE_DECELERATING);
  return arrive(*turn, plan.speed_deg_s);
}

Outcome SweepDriver::sweep_stop_and_go(const SweepPlan& plan) {
  for (std::uint32_t line = 0; line < plan.lines; ++line) {
    Outcome there = go_to(plan.line_angles_deg[line]);
    if (!there) return there;
    Outcome stood = stand_for_line(plan, line);
    if (!stood) return stood;
  }
  announcer_.phase(msg::PHASE_DECELERATING);
  return Done{};
}

Outcome SweepDriver::stand_for_line(const SweepPlan& plan, std::uint32_t line) {
  LineWindow window;
  window.start_ns = after(now_ns(), options_.stand_s);
  window.end_ns = after(window.start_ns, plan.window_s);
  window.start_deg = window.end_deg = plan.line_angles_deg[line];
  window.first_line = line;
  window.lines = 1;
  announcer_.window(window);
  Outcome waited = pause_until(window.end_ns);
  if (!waited) return waited;
  const Result<StepperStatus> status = look();
  if (!status) return Failure{status.reason()};
  const bool stands = status->state == GrblState::kIdle && is_there(*status, window.end_deg);
  if (!stands) return Failure{"the shaft did not stand still: " + what_it_does(*status)};
  return Done{};
}

Outcome SweepDriver::arrive(const Turn& turn, double speed_deg_s) {
  const double run_up_s = speed_deg_s / stepper_.settings().acceleration_deg_s2;
  const double longest_s = std::abs(turn.end_angle_deg - angle_deg_) / speed_deg_s + run_up_s;
  const std::int64_t overdue_ns = after(now_ns(), longest_s + kOverdueS);
  for (;;) {
    const Result<StepperStatus> status = look();
    if (!status) return Failure{status.reason()};
    const bool idle = status->state == GrblState::kIdle;
    if (idle && is_there(*status, turn.end_angle_deg)) return Done{};
    if (idle && status->asked_ns > turn.accepted_ns + kStartGraceNs)
      return Failure{"the turn ended early: " + what_it_does(*status)};
    if (status->asked_ns > overdue_ns)  // not now_ns(): the computer may have stalled since
      return Failure{"the turn does not end: " + what_it_does(*status)};
    Outcome paused = pause_until(now_ns() + kArrivalPollNs);
    if (!paused) return paused;
  }
}

bool SweepDriver::is_there(const StepperStatus& status, double angle_deg) const {
  const double step_deg = 1.0 / stepper_.settings().steps_per_deg;
  const double tolerance_deg =
      options_.axis_measured ? kMeasuredTolerance_deg : 0.5 * step_deg + 0.002;  // of the report
  return std::abs(status.angle_deg - angle_deg) <= tolerance_deg;
}

Result<StepperStatus> SweepDriver::look() {
  heartbeat_.beat();
  Result<StepperStatus> status = stepper_.status();
  if (!status) return status;
  if (status->state != GrblState::kIdle && status->state != GrblState::kJog)
    return Failure{"something else disturbs the motor: " + what_it_does(*status)};
  if (!std::isfinite(status->angle_deg))
    return Failure{"the controller's reports hold no position; send $10=1"};
  angle_deg_ = status->angle_deg;
  announcer_.position(*status);
  return status;
}

Outcome SweepDriver::pause_until(std::int64_t time_ns) const {
  if (!interruption_.pause_until(time_ns)) return Failure{"interrupted"};
  return Done{};
}

}  // namespace swivel
