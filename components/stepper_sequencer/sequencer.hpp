// The participant's logic: homes the shaft, answers requests with sweeps, recovers from faults.
// It knows no DDS: messages come in by request() and go out by the callbacks.
//
// Phases of a request of two sweeps, each a Sweep message:
//   RETURNING (to the start; sweep id 0),
//   ACCELERATING, CRUISING (with the window), DECELERATING, RETURNING,   the first sweep
//   ACCELERATING, CRUISING, DECELERATING, RETURNING,                     the second
//   IDLE
// stop_and_go has one CRUISING a line. A cancel: DECELERATING, RETURNING, IDLE, each with the
// reason "cancelled". A fault: FAULT with the reason and the sweep's id, then HOMING, IDLE. So a
// sweep is whole only when DECELERATING without a reason followed its last window.
// Speed is always that of the mode, also where stop_and_go does not turn at it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/common/heartbeat.hpp"
#include "components/stepper_sequencer/announcer.hpp"
#include "components/stepper_sequencer/interruption.hpp"
#include "components/stepper_sequencer/sweep_driver.hpp"

namespace swivel {

struct SequencerOptions {
  std::string rig = "swivel";
  GrblStepperOptions stepper;
  SweepOptions sweep;
  double poll_interval_s = 0.1;   // of the controller's status, while it turns
  double watch_interval_s = 0.5;  // while it stands
  double shortest_retry_s = 0.5;  // after a fault; doubles
  double longest_retry_s = 10.0;
  // More than the thread that moves the motor is ever silent: homing takes a minute at most.
  std::chrono::milliseconds longest_silence{90000};
};

struct SequencerHealth {
  bool ready = false;  // homed: a request would be taken, or is
  std::string doing;   // in words
  std::string last_error;
  std::int64_t last_error_time_ns = 0;
  std::uint64_t sweeps_done = 0;
  std::uint64_t requests_refused = 0;
  std::uint64_t faults = 0;
  std::uint64_t garbage_lines = 0;       // from the controller
  std::uint64_t positions_left_out = 0;  // measured, but of no certain instant
  std::string firmware;                  // its version
  std::vector<std::string> advice;       // on its settings
};

class Sequencer {
 public:
  // Both callbacks are called from the sequencer's thread and from that of request().
  Sequencer(SequencerOptions options, SequencerOutputs outputs);
  ~Sequencer();  // stops
  Sequencer(const Sequencer&) = delete;
  Sequencer& operator=(const Sequencer&) = delete;

  void start();  // once
  // Ends any motion and the thread, within 2 s. The last message is IDLE, or FAULT when the
  // motor could not be seen to stand.
  void stop();

  // Any thread; does not block. The answer comes as a Sweep.
  void request(const msg::SweepRequest& request);
  // Of the request under way. False: there is none. Any thread; does not block.
  bool cancel();

  SequencerHealth health() const;
  // False once the thread that moves the motor hangs, wherever it does.
  bool works() const { return heartbeat_.was_within(options_.longest_silence); }

 private:
  void run();
  Outcome make_ready();
  Outcome serve();
  Outcome answer(const msg::SweepRequest& request);
  Outcome run_sweeps(const msg::SweepRequest& request, const SweepPlan& plan);
  Outcome abandon(const SweepPlan& plan);
  bool was_cancelled() const;
  Outcome check_standing();
  void recover(const std::string& reason, double retry_s);
  void shut_down();

  std::optional<std::string> why_not_taken(const msg::SweepRequest& request) const;
  std::optional<msg::SweepRequest> await_request();
  void refuse(const msg::SweepRequest& request, const std::string& reason);
  void release(const std::string& why_queued_is_refused = {});
  void note_controller();
  void doing(const std::string& words, bool ready);
  void note_error(const std::string& reason);

  SequencerOptions options_;
  Interruption interruption_;
  Heartbeat heartbeat_;
  Announcer announcer_;
  GrblStepper stepper_;
  SweepDriver driver_;

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable request_came_;
  std::optional<msg::SweepRequest> pending_;
  bool busy_ = false;  // a request is pending or under way
  SequencerHealth health_;

  std::thread thread_;
};

}  // namespace swivel
