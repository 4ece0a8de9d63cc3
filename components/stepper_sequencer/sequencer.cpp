#include "components/stepper_sequencer/sequencer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "hardware/io/clock.hpp"

namespace swivel {

Sequencer::Sequencer(SequencerOptions options, SequencerOutputs outputs)
    : options_(std::move(options)),
      announcer_(options_.rig, options_.sweep.axis_measured, std::move(outputs)),
      stepper_(options_.stepper, &interruption_.stop_signal()),
      driver_(stepper_, options_.sweep, options_.poll_interval_s, announcer_, interruption_,
              heartbeat_) {
  health_.doing = "not started";
}

Sequencer::~Sequencer() {
  stop();
}

void Sequencer::start() {
  assert(!thread_.joinable());
  thread_ = std::thread([this] { run(); });
}

void Sequencer::stop() {
  interruption_.stop();
  {
    const std::lock_guard lock(mutex_);
    request_came_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void Sequencer::run() {
  double retry_s = options_.shortest_retry_s;
  while (!interruption_.stopping()) {
    heartbeat_.beat();
    Outcome fine = make_ready();
    if (fine) {
      retry_s = options_.shortest_retry_s;
      fine = serve();
    }
    if (interruption_.stopping()) break;
    recover(fine.reason(), retry_s);
    retry_s = std::min(2.0 * retry_s, options_.longest_retry_s);
  }
  shut_down();
}

Outcome Sequencer::make_ready() {
  doing("connecting to the controller at " + options_.stepper.address, false);
  Outcome connected = stepper_.connect();
  if (!connected) return connected;
  note_controller();
  heartbeat_.beat();
  doing("homing", false);
  announcer_.phase(msg::PHASE_HOMING);
  return stepper_.home();
}

Outcome Sequencer::serve() {
  doing("waiting for a request", true);
  announcer_.phase(msg::PHASE_IDLE);
  while (!interruption_.stopping()) {
    heartbeat_.beat();
    const std::optional<msg::SweepRequest> request = await_request();
    Outcome fine = request ? answer(*request) : check_standing();
    if (!fine) return fine;
  }
  return Done{};
}

Outcome Sequencer::check_standing() {
  const Result<StepperStatus> status = stepper_.status();
  if (!status) return Failure{status.reason()};
  if (status->state == GrblState::kIdle && stepper_.homed()) return Done{};
  return Failure{std::string("something else uses the controller: it is in state ") +
                 grbl_state_name(status->state)};
}

Outcome Sequencer::answer(const msg::SweepRequest& request) {
  const Result<SweepPlan> plan =
      plan_sweep(options_.sweep, options_.stepper.limits, stepper_.settings(), request.mode(),
                 request.action_sequence());
  const Outcome allowed = plan ? driver_.check(*plan) : Outcome(Failure{plan.reason()});
  if (!allowed) {
    release();
    refuse(request, allowed.reason());
    return Done{};
  }
  Outcome swept = run_sweeps(request, *plan);
  const bool cancelled = !swept && was_cancelled();
  if (cancelled) swept = abandon(*plan);
  if (!swept) return swept;
  release();
  doing("waiting for a request", true);
  announcer_.phase(msg::PHASE_IDLE, cancelled ? "cancelled" : "");
  announcer_.end_request();
  return Done{};
}

// Whether that, and no fault, is why a turn failed.
bool Sequencer::was_cancelled() const {
  return interruption_.interrupted() && !interruption_.stopping() && stepper_.homed();
}

Outcome Sequencer::run_sweeps(const msg::SweepRequest& request, const SweepPlan& plan) {
  announcer_.begin_request(request, plan);
  doing("sweeping in mode " + std::to_string(plan.mode), true);
  announcer_.phase(msg::PHASE_RETURNING);
  Outcome fine = driver_.go_to(plan.start_angle_deg);
  for (int left = request.count() - 1; fine && left >= 0; --left) {
    announcer_.begin_sweep(static_cast<std::uint16_t>(left));
    fine = driver_.sweep(plan);
    if (!fine) break;
    {
      const std::lock_guard lock(mutex_);
      ++health_.sweeps_done;
    }
    announcer_.phase(msg::PHASE_RETURNING);
    fine = driver_.go_to(plan.start_angle_deg);
  }
  return fine;
}

Outcome Sequencer::abandon(const SweepPlan& plan) {
  for (;;) {
    announcer_.phase(msg::PHASE_DECELERATING, "cancelled");
    Outcome halted = stepper_.halt();
    if (!halted) return halted;
    interruption_.clear_cancel();
    announcer_.phase(msg::PHASE_RETURNING, "cancelled");
    Outcome returned = driver_.go_to(plan.start_angle_deg);
    if (returned || !was_cancelled()) return returned;
  }
}

void Sequencer::recover(const std::string& reason, double retry_s) {
  stepper_.cancel();  // before anything else; halt() tells whether it helped
  doing("out of order: " + reason, false);
  note_error(reason);
  announcer_.phase(msg::PHASE_FAULT, reason);
  const Outcome halted = stepper_.halt();
  if (!halted) {
    note_error(halted.reason());
    announcer_.phase(msg::PHASE_FAULT, reason + "; " + halted.reason());
  }
  release("out of order: " + reason);
  announcer_.end_request();
  interruption_.pause_until(now_ns() + std::llround(retry_s * 1e9));
}

void Sequencer::shut_down() {
  const Outcome halted = stepper_.halt();
  doing("stopped", false);
  release("the sequencer is stopping");
  if (halted) {
    announcer_.phase(msg::PHASE_IDLE, "the sequencer is stopping");
  } else {
    note_error(halted.reason());
    announcer_.phase(msg::PHASE_FAULT, "the sequencer is stopping; " + halted.reason());
  }
}

}  // namespace swivel
