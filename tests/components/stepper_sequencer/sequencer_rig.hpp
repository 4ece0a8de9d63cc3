// A sequencer on a GRBL double, with all that it said. Modes turn as fast as the real ones,
// but through a fortieth of the angle, in a fortieth of the lines.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "components/stepper_sequencer/sequencer.hpp"
#include "tests/hardware/stepper/grbl_double.hpp"

namespace swivel::test {

SequencerOptions quick_options(const GrblDouble& peer);

class SequencerRig {
 public:
  using Change = std::function<void(SequencerOptions&)>;
  explicit SequencerRig(const GrblDoubleOptions& peer_options = {}, const Change& change = {});

  // Waits, at most 10 s, until `count` messages of the phase have come since begin; the last of
  // them, or nothing.
  std::optional<msg::Sweep> await(msg::SweepPhase phase, std::size_t count = 1);
  std::optional<msg::Sweep> await_reason(msg::SweepPhase phase, const std::string& part);
  bool ready() { return await(msg::PHASE_IDLE).has_value(); }
  std::uint64_t ask(int mode, int count, msg::SweepSequence sequence = msg::SEQUENCE_IMPROVED);
  void cancel();

  std::vector<msg::Sweep> sweeps() const;
  std::vector<msg::Sweep> sweeps(msg::SweepPhase phase) const;
  std::vector<msg::Axis> axes() const;
  // The double's turn under way at that time; and what it is at in axis angles.
  IdealTurn turn_at(std::int64_t time_ns) const;
  double axis_deg(double machine_deg) const;

  GrblDouble peer;

 private:
  std::optional<msg::Sweep> await_such(const std::function<bool(const msg::Sweep&)>& such,
                                       std::size_t count);

  mutable std::mutex mutex_;
  std::condition_variable said_;
  std::vector<msg::Sweep> sweeps_;
  std::vector<msg::Axis> axes_;
  std::uint64_t last_request_ = 100;

 public:
  Sequencer sequencer;  // the last: it ends first
};

}  // namespace swivel::test
