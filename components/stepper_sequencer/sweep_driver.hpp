// Turns the shaft through one sweep, watches that it does, and announces the windows.
#pragma once

#include <cstdint>
#include <string>

#include "components/common/heartbeat.hpp"
#include "components/stepper_sequencer/announcer.hpp"
#include "components/stepper_sequencer/interruption.hpp"
#include "components/stepper_sequencer/sweep_plan.hpp"
#include "hardware/stepper/grbl_stepper.hpp"

namespace swivel {

// Every Outcome fails on a fault of the controller, on a shaft (as the controller counts) that
// is not where or as fast as it should be, and on an interruption. It does not stop the motor:
// the caller does.
class SweepDriver {
 public:
  SweepDriver(GrblStepper& stepper, const SweepOptions& options, double poll_interval_s,
              Announcer& announcer, const Interruption& interruption, Heartbeat& heartbeat);

  // Whether the controller allows all turns of the plan.
  Outcome check(const SweepPlan& plan) const;
  Outcome go_to(double angle_deg);
  Outcome sweep(const SweepPlan& plan);

 private:
  Outcome sweep_improved(const SweepPlan& plan);
  Outcome sweep_naive(const SweepPlan& plan);
  Outcome sweep_stop_and_go(const SweepPlan& plan);

  Outcome confirm_window(const SweepPlan& plan, const Turn& turn, LineWindow& window);
  Outcome watch_window(const SweepPlan& plan, const LineWindow& window);
  Outcome arrive(const Turn& turn, double speed_deg_s);
  Outcome stand_for_line(const SweepPlan& plan, std::uint32_t line);

  bool is_there(const StepperStatus& status, double angle_deg) const;
  Result<StepperStatus> look();
  Outcome pause_until(std::int64_t time_ns) const;

  GrblStepper& stepper_;
  SweepOptions options_;
  std::int64_t poll_interval_ns_;
  Announcer& announcer_;
  const Interruption& interruption_;
  Heartbeat& heartbeat_;
  double angle_deg_ = 0.0;  // at the last look
};

}  // namespace swivel
