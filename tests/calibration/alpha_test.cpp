#include "calibration/alpha.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace swivel {
namespace {

constexpr double kAlphaRad = rad_from_deg(29.36);

Plane wall(double azimuth_rad, std::size_t points) {
  Plane plane;
  plane.normal = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
  plane.distance_m = 2.0;
  plane.rms_m = 0.01;
  plane.points = points;
  plane.azimuth_sigma_rad = rad_from_deg(0.005);
  return plane;
}

// What a sweep sees that starts phi_offset away from the front, with the plate at kAlphaRad, in
// a room that stands at yaw_rad.
AlphaSweep perfect_sweep(double phi_offset_rad, double yaw_rad = 0.0) {
  AlphaSweep sweep;
  sweep.beta_rad = kAlphaRad - phi_offset_rad;
  sweep.beta_sigma_rad = rad_from_deg(0.13);
  for (int side = 0; side < 4; ++side) {
    sweep.walls.push_back(wall(yaw_rad + side * kPi / 2 - phi_offset_rad, 5000));
  }
  return sweep;
}

std::vector<AlphaSweep> perfect_sweeps(double yaw_rad = 0.0) {
  return {perfect_sweep(rad_from_deg(1.2), yaw_rad), perfect_sweep(rad_from_deg(-3.4), yaw_rad),
          perfect_sweep(rad_from_deg(4.9), yaw_rad), perfect_sweep(0.0, yaw_rad)};
}

AlphaFit fitted(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options = {}) {
  const AlphaResult result = fit_alpha(sweeps, options);
  EXPECT_TRUE(result.fit) << result.reason;
  return result.fit.value_or(AlphaFit());
}

void expect_refused(const std::vector<AlphaSweep>& sweeps, const std::vector<std::string>& words,
                    const AlphaOptions& options = {}) {
  const AlphaResult result = fit_alpha(sweeps, options);
  EXPECT_FALSE(result.fit);
  for (const std::string& word : words) {
    EXPECT_NE(result.reason.find(word), std::string::npos) << result.reason;
  }
}

TEST(Alpha, IsExactWithoutNoise) {
  const AlphaFit fit = fitted(perfect_sweeps());
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad, 1e-9);
  EXPECT_LT(fit.residual_rms_rad, 1e-9);
  EXPECT_EQ(fit.sweeps_used, 4U);
  EXPECT_TRUE(fit.converged);
  EXPECT_GT(fit.iterations, 0);
  // What the sweeps' own sigmas say, however well they happen to agree.
  EXPECT_NEAR(fit.sigma_rad, rad_from_deg(0.13) / 2, rad_from_deg(0.001));
}

TEST(Alpha, WhereTheSearchStartsDoesNotMatter) {
  for (const double start_deg : {12.0, 25.0, 48.0}) {
    AlphaOptions options;
    options.initial_alpha_rad = rad_from_deg(start_deg);
    EXPECT_NEAR(fitted(perfect_sweeps(), options).alpha_rad, kAlphaRad, 1e-9) << start_deg;
  }
}

TEST(Alpha, TurningTheRoomTurnsAlphaTheOtherWayUnlessItsYawIsGiven) {
  const double yaw_rad = rad_from_deg(2.5);
  EXPECT_NEAR(fitted(perfect_sweeps(yaw_rad)).alpha_rad, kAlphaRad - yaw_rad, 1e-9);
  AlphaOptions told;
  told.room_yaw_rad = yaw_rad;
  EXPECT_NEAR(fitted(perfect_sweeps(yaw_rad), told).alpha_rad, kAlphaRad, 1e-9);
  told.room_yaw_rad = rad_from_deg(-105.0);
  EXPECT_NEAR(fitted(perfect_sweeps(told.room_yaw_rad), told).alpha_rad, kAlphaRad, 1e-9);
}

TEST(Alpha, TurningEveryPlateByAnAngleAddsItToAlpha) {
  auto sweeps = perfect_sweeps();
  for (AlphaSweep& sweep : sweeps) sweep.beta_rad += rad_from_deg(1.7);
  EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad + rad_from_deg(1.7), 1e-9);
}

TEST(Alpha, FurnitureAndTheOrderOfWallsDoNotMatter) {
  auto sweeps = perfect_sweeps();
  for (AlphaSweep& sweep : sweeps) {
    sweep.walls.insert(sweep.walls.begin(), wall(0.6, 900));
    sweep.walls.push_back(wall(sweep.walls.back().azimuth_rad() + 0.1, 700));
    std::reverse(sweep.walls.begin(), sweep.walls.end());
  }
  EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad, 1e-9);
}

TEST(Alpha, OneWallOutOfSquareHardlyMovesItAndIsNamedByItsAngle) {
  auto sweeps = perfect_sweeps();
  for (AlphaSweep& sweep : sweeps) {
    sweep.walls[1] = wall(sweep.walls[1].azimuth_rad() + rad_from_deg(0.5), 5000);
  }
  const AlphaFit fit = fitted(sweeps);
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad, rad_from_deg(0.03));
  // The second wall's normal points to azimuth 90: it is the right-hand one.
  EXPECT_NEAR(fit.wall_angles_rad[static_cast<std::size_t>(Wall::kRight)], rad_from_deg(0.5),
              rad_from_deg(0.03));
  EXPECT_NEAR(fit.wall_angles_rad[static_cast<std::size_t>(Wall::kFront)], 0.0, rad_from_deg(0.03));
}

std::vector<AlphaSweep> noisy_sweeps(std::size_t count, double sigma_deg, std::mt19937& random) {
  std::normal_distribution<double> beta_noise_deg(0.0, sigma_deg);
  std::normal_distribution<double> wall_noise_deg(0.0, 0.02);
  std::uniform_real_distribution<double> offset_deg(-5.0, 5.0);
  std::vector<AlphaSweep> sweeps;
  for (std::size_t sweep = 0; sweep < count; ++sweep) {
    sweeps.push_back(perfect_sweep(rad_from_deg(offset_deg(random))));
    sweeps.back().beta_rad += rad_from_deg(beta_noise_deg(random));
    sweeps.back().beta_sigma_rad = rad_from_deg(sigma_deg);
    for (Plane& plane : sweeps.back().walls) {
      plane = wall(plane.azimuth_rad() + rad_from_deg(wall_noise_deg(random)), 5000);
      plane.azimuth_sigma_rad = rad_from_deg(0.02);
    }
  }
  return sweeps;
}

TEST(Alpha, SigmaIsHonestForFewSweepsAndForMany) {
  for (const std::size_t count : {3U, 5U, 20U}) {
    std::mt19937 random(static_cast<unsigned>(count));
    double squares = 0.0;
    int within = 0;
    constexpr int kRuns = 200;
    for (int run = 0; run < kRuns; ++run) {
      const AlphaFit fit = fitted(noisy_sweeps(count, 0.13, random));
      const double errors_in_sigmas = (fit.alpha_rad - kAlphaRad) / fit.sigma_rad;
      squares += errors_in_sigmas * errors_in_sigmas;
      if (std::abs(errors_in_sigmas) < 1.0) ++within;
    }
    EXPECT_GT(std::sqrt(squares / kRuns), 0.65) << count;
    EXPECT_LT(std::sqrt(squares / kRuns), 1.2) << count;
    EXPECT_GT(within, 0.60 * kRuns) << count;
    EXPECT_LT(within, 0.88 * kRuns) << count;
  }
}

TEST(Alpha, ScatterAboveTheSweepsOwnSigmasWidensSigma) {
  std::mt19937 random(7);
  auto sweeps = noisy_sweeps(20, 0.3, random);
  for (AlphaSweep& sweep : sweeps) sweep.beta_sigma_rad = rad_from_deg(0.15);
  EXPECT_GT(fitted(sweeps).sigma_rad, rad_from_deg(0.3 / std::sqrt(20.0) * 0.7));
}

TEST(Alpha, WallsOutOfSquareLimitSigmaHoweverManySweeps) {
  std::vector<AlphaSweep> sweeps(400, perfect_sweep(0.01));
  for (AlphaSweep& sweep : sweeps) {
    for (std::size_t side = 0; side < 4; ++side) {
      const double off_deg = side % 2 == 0 ? 0.06 : -0.06;
      sweep.walls[side] = wall(sweep.walls[side].azimuth_rad() + rad_from_deg(off_deg), 5000);
    }
  }
  EXPECT_GT(fitted(sweeps).sigma_rad, rad_from_deg(0.02));
}

TEST(Alpha, TooFewSweepsAreRefused) {
  expect_refused({}, {"0 sweeps", "3 needed"});
  expect_refused({perfect_sweep(0.0), perfect_sweep(0.1)}, {"2 sweeps", "3 needed"});
}

TEST(Alpha, AMissingWallIsRefusedWithItsSweepAndSide) {
  auto sweeps = perfect_sweeps();
  sweeps[2].walls.erase(sweeps[2].walls.begin());  // its normal pointed to azimuth 0: the back
  expect_refused(sweeps, {"sweep 3", "3 of 4 walls", "without back"});
  sweeps[2].walls.clear();
  expect_refused(sweeps, {"sweep 3", "0 of 4 walls", "front, left, back, right"});
}

TEST(Alpha, ARoomTooFarOffTheFrontIsRefused) {
  expect_refused(perfect_sweeps(rad_from_deg(27.0)), {"sweep 1", "0 of 4", "20 deg", "yaw"});
}

TEST(Alpha, ACornerOutOfSquareIsRefused) {
  auto sweeps = perfect_sweeps();
  for (AlphaSweep& sweep : sweeps) {
    sweep.walls[3] = wall(sweep.walls[3].azimuth_rad() + rad_from_deg(8.0), 5000);
  }
  expect_refused(sweeps, {"left", "deg off square"});
}

TEST(Alpha, ASweepThatDisagreesIsRefusedByName) {
  auto sweeps = perfect_sweeps();
  sweeps[1].beta_rad += rad_from_deg(1.0);
  expect_refused(sweeps, {"disagree", "sweep 2", "times its sigma"});
}

TEST(Alpha, ASweepWithoutAttitudeIsRefusedByName) {
  auto sweeps = perfect_sweeps();
  sweeps[3].beta_rad = std::nan("");
  expect_refused(sweeps, {"sweep 4", "no attitude"});
}

}  // namespace
}  // namespace swivel
