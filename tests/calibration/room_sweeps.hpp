// What sweeps see of a room of four walls, worked out by hand: for tests of alpha.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "calibration/alpha.hpp"

namespace swivel {

inline constexpr double kAlphaRad = rad_from_deg(29.36);

inline Plane wall(double azimuth_rad, std::size_t points) {
  Plane plane;
  plane.normal = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
  plane.distance_m = 2.0;
  plane.rms_m = 0.01;
  plane.points = points;
  plane.length_m = 4.0;
  plane.height_m = 2.5;
  plane.azimuth_sigma_rad = rad_from_deg(0.005);
  return plane;
}

inline Plane turned(Plane plane, double angle_rad) {
  const double azimuth_rad = plane.azimuth_rad() + angle_rad;
  plane.normal = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
  return plane;
}

inline void turn_wall(std::vector<AlphaSweep>& sweeps, std::size_t index, double angle_rad) {
  for (AlphaSweep& sweep : sweeps) sweep.walls[index] = turned(sweep.walls[index], angle_rad);
}

inline std::string remarks_of(const AlphaFit& fit) {
  std::string all;
  for (const std::string& remark : fit.remarks) all += remark + "\n";
  return all;
}

// What a sweep sees that starts phi_offset away from the front, with the plate at kAlphaRad, in
// a room that stands at yaw_rad.
inline AlphaSweep perfect_sweep(double phi_offset_rad, double yaw_rad = 0.0) {
  AlphaSweep sweep;
  sweep.beta_rad = kAlphaRad - phi_offset_rad;
  sweep.beta_sigma_rad = rad_from_deg(0.13);
  for (int side = 0; side < 4; ++side) {
    sweep.walls.push_back(wall(yaw_rad + side * kPi / 2 - phi_offset_rad, 5000));
    sweep.walls.back().distance_m = 2.0 + side;
  }
  return sweep;
}

inline std::vector<AlphaSweep> perfect_sweeps(double yaw_rad = 0.0) {
  return {perfect_sweep(rad_from_deg(1.2), yaw_rad), perfect_sweep(rad_from_deg(-3.4), yaw_rad),
          perfect_sweep(rad_from_deg(4.9), yaw_rad), perfect_sweep(0.0, yaw_rad)};
}

inline AlphaFit fitted(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options = {}) {
  const AlphaResult result = fit_alpha(sweeps, options);
  EXPECT_TRUE(result.fit) << result.reason;
  return result.fit.value_or(AlphaFit());
}

inline void expect_refused(const std::vector<AlphaSweep>& sweeps,
                           const std::vector<std::string>& words,
                           const AlphaOptions& options = {}) {
  const AlphaResult result = fit_alpha(sweeps, options);
  EXPECT_FALSE(result.fit);
  for (const std::string& word : words) {
    EXPECT_NE(result.reason.find(word), std::string::npos) << result.reason;
  }
}

}  // namespace swivel
