#include "tests/components/stepper_sequencer/sequencer_rig.hpp"

#include <chrono>

namespace swivel::test {
namespace {

using namespace std::chrono_literals;

SequencerOptions changed(SequencerOptions options, const SequencerRig::Change& change) {
  if (change) change(options);
  return options;
}

}  // namespace

SequencerOptions quick_options(const GrblDouble& peer) {
  SequencerOptions options;
  options.stepper.address = peer.address();
  options.stepper.limits = {-75.0, 330.0, 30.0};
  options.stepper.banner_timeout = 1s;
  options.stepper.status_timeout = 1s;  // as long as a busy machine may keep the double waiting
  options.sweep.sweep_angle_deg = 4.5;
  options.sweep.lines_of_mode = {{1, 1}, {2, 2}, {3, 4}, {4, 5}, {5, 8}, {6, 10}, {7, 16}};
  options.sweep.settle_s = 0.3;  // and here the sequencer
  options.sweep.return_speed_deg_s = 900.0;
  options.sweep.stand_s = 0.01;
  options.watch_interval_s = 0.05;
  options.shortest_retry_s = 0.01;
  return options;
}

SequencerRig::SequencerRig(const GrblDoubleOptions& peer_options, const Change& change)
    : peer(peer_options),
      sequencer(changed(quick_options(peer), change), {[this](const msg::Sweep& sweep) {
                                                         const std::lock_guard lock(mutex_);
                                                         sweeps_.push_back(sweep);
                                                         said_.notify_all();
                                                       },
                                                       [this](const msg::Axis& axis) {
                                                         const std::lock_guard lock(mutex_);
                                                         axes_.push_back(axis);
                                                       }}) {
  sequencer.start();
}

std::optional<msg::Sweep> SequencerRig::await_such(
    const std::function<bool(const msg::Sweep&)>& such, std::size_t count) {
  std::optional<msg::Sweep> found;
  const auto all_there = [&] {
    std::size_t seen = 0;
    for (const msg::Sweep& sweep : sweeps_) {
      if (such(sweep) && ++seen == count) found = sweep;
    }
    return found.has_value();
  };
  std::unique_lock lock(mutex_);
  said_.wait_for(lock, 10s, all_there);
  return found;
}

std::optional<msg::Sweep> SequencerRig::await(msg::SweepPhase phase, std::size_t count) {
  return await_such([=](const msg::Sweep& sweep) { return sweep.phase() == phase; }, count);
}

std::optional<msg::Sweep> SequencerRig::await_reason(msg::SweepPhase phase,
                                                     const std::string& part) {
  return await_such(
      [=](const msg::Sweep& sweep) {
        return sweep.phase() == phase && sweep.reason().find(part) != std::string::npos;
      },
      1);
}

std::uint64_t SequencerRig::ask(int mode, int count, msg::SweepSequence sequence) {
  msg::SweepRequest request;
  request.rig("swivel");
  request.request_id(++last_request_);
  request.mode(static_cast<std::uint8_t>(mode));
  request.count(static_cast<std::uint16_t>(count));
  request.action_sequence(sequence);
  sequencer.request(request);
  return last_request_;
}

void SequencerRig::cancel() {
  msg::SweepRequest request;
  request.rig("swivel");
  request.cancel(true);
  sequencer.request(request);
}

std::vector<msg::Sweep> SequencerRig::sweeps() const {
  const std::lock_guard lock(mutex_);
  return sweeps_;
}

std::vector<msg::Sweep> SequencerRig::sweeps(msg::SweepPhase phase) const {
  std::vector<msg::Sweep> matching;
  for (const msg::Sweep& sweep : sweeps()) {
    if (sweep.phase() == phase) matching.push_back(sweep);
  }
  return matching;
}

std::vector<msg::Axis> SequencerRig::axes() const {
  const std::lock_guard lock(mutex_);
  return axes_;
}

IdealTurn SequencerRig::turn_at(std::int64_t time_ns) const {
  IdealTurn latest;
  for (const IdealTurn& turn : peer.turns()) {
    if (turn.start_ns <= time_ns) latest = turn;
  }
  return latest;
}

double SequencerRig::axis_deg(double machine_deg) const {
  return -75.0 + machine_deg + 359.0;  // the double's home switch is at -(360 - 1)
}

}  // namespace swivel::test
