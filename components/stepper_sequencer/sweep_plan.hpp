// Where and how fast the shaft turns for one sweep, and when its lines count. Pure.
//
// Improved sequence (Yuan 2021, figure 2), axis angle 0 where the window opens:
//
//   speed  w |        ____________________________________
//            |       /:      :                    :      :\        run_up = w / a, w^2 / 2a deg
//            |      / :settle:  window            :settle: \       window = (lines + 2) periods
//          0 |_____/  :      :                    :      :  \__
//   angle      start         0                                end
//
// A window holds `lines` whole lines wherever it falls between two lines (one period more), and
// though the lidar be slower than nominal (the tolerance); the second period more is for what
// the clocks of lidar and computer do not agree on.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "hardware/stepper/stepper_settings.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct SweepOptions {
  double sweep_angle_deg = 180.0;
  std::map<int, std::uint32_t> lines_of_mode = {{1, 40},  {2, 80},  {3, 160}, {4, 200},
                                                {5, 320}, {6, 400}, {7, 640}};
  double line_period_s = 0.025;          // nominal, of the lidar
  double line_period_tolerance = 0.005;  // by how much of it the true one may be longer
  double settle_s = 0.15;                // of constant speed before the first line, after the last
  double stand_s = 0.1;                  // stop_and_go: from standing still to the line
  double return_speed_deg_s = 90.0;      // also of stop_and_go's steps
  bool axis_measured = false;            // the controller's positions are measured, not counted
};

struct SweepPlan {
  int mode = 0;
  msg::SweepSequence sequence = msg::SEQUENCE_IMPROVED;
  std::uint32_t lines = 0;
  double speed_deg_s = 0.0;      // the mode's; stop_and_go does not turn at it
  double start_angle_deg = 0.0;  // the shaft waits here; whole steps
  double end_angle_deg = 0.0;    // and is turned to here; whole steps

  // Of the one window of improved and naive:
  double steady_start_deg = 0.0;  // between these two angles the speed is constant
  double steady_end_deg = 0.0;
  double window_delay_s = 0.0;  // from the motor's start to the window's
  double window_s = 0.0;
  double window_angle_deg = 0.0;  // where it opens

  // stop_and_go: where line k is taken, each of whole steps; window_s is a line's.
  std::vector<double> line_angles_deg;
};

// Fails on a mode that is not in the table and on an unknown sequence. Whether the controller
// allows the turns is for GrblStepper::check_move.
Result<SweepPlan> plan_sweep(const SweepOptions& options, const TurnLimits& limits,
                             const StepperSettings& settings, int mode,
                             msg::SweepSequence sequence);

}  // namespace swivel
