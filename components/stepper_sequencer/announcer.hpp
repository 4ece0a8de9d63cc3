// Puts what the sequencer does into messages. Safe for several threads; the two callbacks are
// called one at a time and must not call back.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "components/stepper_sequencer/measured_axis.hpp"
#include "components/stepper_sequencer/sweep_plan.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct SequencerOutputs {
  std::function<void(const msg::Sweep&)> sweep;
  std::function<void(const msg::Axis&)> axis;
};

// The lines [first_line, first_line + lines) lie in [start_ns, end_ns]; the axis turns from
// start_deg to end_deg meanwhile, at constant speed.
struct LineWindow {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  double start_deg = 0.0;
  double end_deg = 0.0;
  std::uint32_t first_line = 0;
  std::uint32_t lines = 0;
};

class Announcer {
 public:
  // axis_measured: the angles said are those of position(), not those commanded in a window.
  Announcer(const std::string& rig, bool axis_measured, SequencerOutputs outputs);

  // What is said from now on belongs to this request, and to no sweep yet.
  void begin_request(const msg::SweepRequest& request, const SweepPlan& plan);
  // And from now on to the next sweep of it. Its id is unique across restarts: seconds since
  // 1970 or, within the same second, the next number.
  void begin_sweep(std::uint16_t sweeps_left);
  void phase(msg::SweepPhase phase, const std::string& reason = {});
  void window(const LineWindow& window);  // a commanded axis first, then phase CRUISING
  void end_request();                     // no sweep is spoken of any more

  // What the controller said of the axis; published where it is measured.
  void position(const StepperStatus& report);
  std::uint64_t positions_left_out() const;

  // Answers a request that is not taken. What is under way goes on.
  void refuse(const msg::SweepRequest& request, const std::string& reason);
  // The present phase once more, with a reason.
  void repeat(const std::string& reason);

 private:
  void publish(msg::Sweep sweep, const std::string& reason);
  void publish_commanded(const LineWindow& window);

  mutable std::mutex mutex_;
  SequencerOutputs outputs_;
  bool axis_measured_;
  MeasuredAxis measured_;
  msg::Sweep now_;  // as last said, without the reason
  std::uint64_t last_sweep_id_ = 0;
};

}  // namespace swivel
