#include "components/stepper_sequencer/announcer.hpp"

#include <algorithm>
#include <utility>

#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

msg::AxisSample sample_at(std::int64_t time_ns, double angle_deg) {
  msg::AxisSample sample;
  sample.time_ns(time_ns);
  sample.angle_deg(angle_deg);
  return sample;
}

}  // namespace

Announcer::Announcer(const std::string& rig, bool axis_measured, SequencerOutputs outputs)
    : outputs_(std::move(outputs)), axis_measured_(axis_measured) {
  now_.rig(rig);
  now_.phase(msg::PHASE_IDLE);
}

void Announcer::begin_request(const msg::SweepRequest& request, const SweepPlan& plan) {
  end_request();
  const std::lock_guard lock(mutex_);
  now_.request_id(request.request_id());
  now_.mode(request.mode());
  now_.action_sequence(plan.sequence);
  now_.speed_deg_s(plan.speed_deg_s);
  now_.lines_expected(plan.lines);
  now_.sweeps_left(request.count());
}

void Announcer::begin_sweep(std::uint16_t sweeps_left) {
  const std::lock_guard lock(mutex_);
  const auto seconds = static_cast<std::uint64_t>(now_ns() / kNsPerSecond);
  last_sweep_id_ = std::max(last_sweep_id_ + 1, seconds);
  now_.sweep_id(last_sweep_id_);
  now_.sweeps_left(sweeps_left);
  now_.window_start_ns(0);
  now_.window_end_ns(0);
  now_.window_first_line(0);
  now_.window_lines(0);
}

void Announcer::end_request() {
  const std::lock_guard lock(mutex_);
  msg::Sweep blank;
  blank.rig(now_.rig());
  blank.phase(now_.phase());
  now_ = std::move(blank);
}

void Announcer::phase(msg::SweepPhase phase, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  now_.phase(phase);
  publish(now_, reason);
}

void Announcer::repeat(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  publish(now_, reason);
}

void Announcer::window(const LineWindow& window) {
  const std::lock_guard lock(mutex_);
  if (!axis_measured_) publish_commanded(window);
  now_.phase(msg::PHASE_CRUISING);
  now_.window_start_ns(window.start_ns);
  now_.window_end_ns(window.end_ns);
  now_.window_first_line(window.first_line);
  now_.window_lines(window.lines);
  publish(now_, {});
}

void Announcer::publish_commanded(const LineWindow& window) {
  msg::Axis axis;
  axis.rig(now_.rig());
  axis.source(msg::AXIS_COMMANDED);
  axis.samples().push_back(sample_at(window.start_ns, window.start_deg));
  axis.samples().push_back(sample_at(window.end_ns, window.end_deg));
  outputs_.axis(axis);
}

void Announcer::position(const StepperStatus& report) {
  const std::lock_guard lock(mutex_);
  if (!axis_measured_) return;
  const auto sample = measured_.add(report);
  if (!sample) return;
  msg::Axis axis;
  axis.rig(now_.rig());
  axis.source(msg::AXIS_MEASURED);
  axis.samples().push_back(*sample);
  outputs_.axis(axis);
}

std::uint64_t Announcer::positions_left_out() const {
  const std::lock_guard lock(mutex_);
  return measured_.left_out();
}

void Announcer::refuse(const msg::SweepRequest& request, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  msg::Sweep refusal;
  refusal.rig(now_.rig());
  refusal.request_id(request.request_id());
  refusal.mode(request.mode());
  refusal.action_sequence(request.action_sequence());
  refusal.phase(msg::PHASE_REFUSED);
  publish(std::move(refusal), reason);
}

void Announcer::publish(msg::Sweep sweep, const std::string& reason) {
  sweep.time_ns(now_ns());
  sweep.reason(reason);
  outputs_.sweep(sweep);
}

}  // namespace swivel
