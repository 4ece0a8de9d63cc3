// The lidar: which one, how it is mounted, and its faults.
#pragma once

#include "hardware/sim/placement.hpp"
#include "hardware/sim/sensor_model.hpp"

namespace swivel::sim {

struct LidarOptions {
  SensorModel sensor;
  Placement axis;                                   // of the axis in the base, frame O
  Placement mounting{{13.9, 0.0, 0.0}, {0, 0, 0}};  // of the lidar on the axis
  double bias_deg = 0.0;                            // added to every beam's angle (Zeng 2018)
  double noise_mm = 13.0;
  double range_bias_mm = 0.0;
  double near_bias_mm = 0.0;    // at range 0, fading with a length of 0.3 m
  double dropout_rate = 0.005;  // of echoes lost for no reason

  // The beam's width. Its power falls off as a Gaussian, to exp(-2) at the radius, and ends there.
  double spot_radius_mm = 0.0;   // at the lidar; 0 is a pencil, and what follows says nothing
  double divergence_mrad = 0.0;  // of the radius, far away: mm a metre
  // A spot on an edge gives several echoes: the sensor answers the nearest that has this part of
  // the energy, or else the strongest. The part is drawn for each beam.
  double echo_fraction = 0.5;
  double echo_jitter = 0.0;       // up to this part of echo_fraction more or less
  double gain_knee_mm = 300.0;    // an echo from there has half the energy of one from close by
  double echo_merge_mm = 500.0;   // surfaces no further apart than this give one echo between
  double mixed_pixel_rate = 0.3;  // of beams with two good echoes that answer something between
};

}  // namespace swivel::sim
