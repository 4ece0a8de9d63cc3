// Sweeps of a lidar on a pan unit, in the bench's world, with geometry of their own: what the
// estimators of the mounting are tested with.
#pragma once

#include <cstdint>

#include "calibration/mounting_model.hpp"
#include "calibration/sweep_readings.hpp"
#include "hardware/sim/world.hpp"

namespace swivel {

struct PanScan {
  double bias_deg = 0.0;  // of the centreline
  // The lidar on the axis: first about the axis X, then Y, then Z, then shifted.
  double rx_deg = 0.0;
  double ry_deg = 0.0;
  double rz_deg = 0.0;
  double tx_mm = 0.0;
  double ty_mm = 0.0;
  double tz_mm = 0.0;

  std::size_t lines = 180;
  double turn_deg = 360.0;
  double start_deg = 0.0;
  bool turning_down = false;
  double hysteresis_deg = 0.0;  // of the shaft behind the measured angle, where it turns down
  double noise_mm = 10.0;
  double range_offset_mm = 0.0;
  double angle_sigma_deg = 0.003;
  bool roof_only = false;
  double roof_lean_deg = 0.0;  // with roof_only
  sim::RoomOptions room;
  std::uint64_t seed = 1;
};

// 1081 beams from -135 deg, 0.25 deg apart, in whole millimetres from 0.1 to 30 m.
SweepReadings scan_of(const PanScan& scan);

// As the estimators should find it: roll is in the bias, yaw in the lever arm's direction.
MountingVector true_mounting(const PanScan& scan);

}  // namespace swivel
