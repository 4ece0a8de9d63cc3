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
  plane.length_m = 4.0;
  plane.height_m = 2.5;
  plane.azimuth_sigma_rad = rad_from_deg(0.005);
  return plane;
}

Plane turned(Plane plane, double angle_rad) {
  const double azimuth_rad = plane.azimuth_rad() + angle_rad;
  plane.normal = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
  return plane;
}

void turn_wall(std::vector<AlphaSweep>& sweeps, std::size_t index, double angle_rad) {
  for (AlphaSweep& sweep : sweeps) sweep.walls[index] = turned(sweep.walls[index], angle_rad);
}

std::string remarks_of(const AlphaFit& fit) {
  std::string all;
  for (const std::string& remark : fit.remarks) all += remark + "\n";
  return all;
}

// What a sweep sees that starts phi_offset away from the front, with the plate at kAlphaRad, in
// a room that stands at yaw_rad.
AlphaSweep perfect_sweep(double phi_offset_rad, double yaw_rad = 0.0) {
  AlphaSweep sweep;
  sweep.beta_rad = kAlphaRad - phi_offset_rad;
  sweep.beta_sigma_rad = rad_from_deg(0.13);
  for (int side = 0; side < 4; ++side) {
    sweep.walls.push_back(wall(yaw_rad + side * kPi / 2 - phi_offset_rad, 5000));
    sweep.walls.back().distance_m = 2.0 + side;
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

// Seen by more points than the wall behind it, as what is near is.
TEST(Alpha, ALargeCupboardIsNotTakenForTheWallBehindIt) {
  for (const double askew_deg : {1.0, 4.0}) {
    auto sweeps = perfect_sweeps();
    for (AlphaSweep& sweep : sweeps) {
      Plane doors = turned(sweep.walls[2], rad_from_deg(askew_deg));
      doors.distance_m -= 0.6;
      doors.points = 20'000;
      doors.length_m = 2.0;
      doors.height_m = 2.2;
      sweep.walls.insert(sweep.walls.begin(), doors);
    }
    EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad, 1e-9) << askew_deg;
  }
}

// A strip of another room, seen through a door, says less than the wall that the door is in.
TEST(Alpha, AStripFarBehindIsNotTakenForTheWall) {
  auto sweeps = perfect_sweeps();
  for (AlphaSweep& sweep : sweeps) {
    Plane strip = turned(sweep.walls[2], rad_from_deg(1.5));
    strip.distance_m += 4.0;
    strip.length_m = 0.9;
    sweep.walls.push_back(strip);
  }
  EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad, 1e-9);
}

TEST(Alpha, WhatComesAndGoesIsNoWall) {
  auto sweeps = perfect_sweeps();
  Plane someone = turned(sweeps[1].walls[0], rad_from_deg(1.0));
  someone.distance_m += 1.0;  // behind a door that was open
  someone.length_m = 9.0;
  sweeps[1].walls.push_back(someone);
  EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad, 1e-9);
}

TEST(Alpha, OneWallInOneSweepThatWasSomethingElseIsLeftOutByName) {
  auto sweeps = perfect_sweeps();
  sweeps[2].walls[1] = turned(sweeps[2].walls[1], rad_from_deg(0.8));
  const AlphaFit fit = fitted(sweeps);
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad, 1e-9);
  EXPECT_TRUE(fit.model_holds);
  EXPECT_NE(remarks_of(fit).find("right wall in sweep 3"), std::string::npos) << remarks_of(fit);
}

TEST(Alpha, OneWallOutOfSquareHardlyMovesItAndIsNamedByItsAngle) {
  for (const double skew_deg : {0.5, -0.5, 1.2}) {
    for (std::size_t index = 0; index < kWalls; ++index) {
      auto sweeps = perfect_sweeps();
      turn_wall(sweeps, index, rad_from_deg(skew_deg));
      for (AlphaSweep& sweep : sweeps) sweep.walls[index].azimuth_sigma_rad = rad_from_deg(0.0005);
      const AlphaFit fit = fitted(sweeps);
      EXPECT_NEAR(fit.alpha_rad, kAlphaRad, rad_from_deg(0.01)) << index;
      const std::size_t side = (index + 2) % kWalls;  // its normal points the other way
      EXPECT_NEAR(fit.wall_angles_rad[side], rad_from_deg(skew_deg), rad_from_deg(0.01));
      EXPECT_NEAR(fit.wall_angles_rad[(side + 1) % kWalls], 0.0, rad_from_deg(0.01));
      EXPECT_NE(remarks_of(fit).find("deg off square"), std::string::npos);
    }
  }
}

// The loss looks at each wall's own angle, not at how the sweeps' betas scatter.
TEST(Alpha, AWallOutOfSquareIsToldFromSweepsThatScatter) {
  std::vector<AlphaSweep> sweeps;
  for (int sweep = 0; sweep < 40; ++sweep) {
    sweeps.push_back(perfect_sweep(0.02 * std::sin(sweep)));
    sweeps.back().beta_rad += rad_from_deg(sweep % 2 == 0 ? 0.4 : -0.4);
    sweeps.back().beta_sigma_rad = rad_from_deg(0.4);
  }
  turn_wall(sweeps, 1, rad_from_deg(0.5));
  EXPECT_NEAR(fitted(sweeps).alpha_rad, kAlphaRad, rad_from_deg(0.01));
}

TEST(Alpha, AWallFarOutOfSquareIsLeftOutByName) {
  auto sweeps = perfect_sweeps();
  turn_wall(sweeps, 3, rad_from_deg(8.0));
  const AlphaFit fit = fitted(sweeps);
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad, 1e-9);
  EXPECT_NE(remarks_of(fit).find("left by 8 deg"), std::string::npos) << remarks_of(fit);
  EXPECT_TRUE(std::isnan(fit.wall_angles_rad[static_cast<std::size_t>(Wall::kLeft)]));
}

std::vector<AlphaSweep> without_walls(std::vector<AlphaSweep> sweeps,
                                      const std::vector<std::size_t>& descending) {
  for (AlphaSweep& sweep : sweeps) {
    for (const std::size_t index : descending) {
      sweep.walls.erase(sweep.walls.begin() + static_cast<std::ptrdiff_t>(index));
    }
  }
  return sweeps;
}

TEST(Alpha, FewerWallsWillDoWithALargerSigma) {
  const double of_four_rad = fitted(perfect_sweeps()).walls_sigma_rad;
  const double of_three_rad = fitted(without_walls(perfect_sweeps(), {1})).walls_sigma_rad;
  EXPECT_LT(of_four_rad, of_three_rad);
  for (const std::vector<std::size_t>& gone :
       std::vector<std::vector<std::size_t>>{{3, 1}, {2, 0}, {3, 2}, {2, 1}}) {
    const AlphaFit fit = fitted(without_walls(perfect_sweeps(), gone));
    EXPECT_NEAR(fit.alpha_rad, kAlphaRad, 1e-9);
    EXPECT_LT(of_three_rad, fit.walls_sigma_rad);
    EXPECT_NE(remarks_of(fit).find("no wall seen"), std::string::npos);
  }
  expect_refused(without_walls(perfect_sweeps(), {3, 2, 0}), {"only 1 of 4 walls"});
}

// Neither of two walls that are half a degree apart is the right one.
TEST(Alpha, TwoWallsThatDisagreeGiveASigmaOfHalfTheirAngle) {
  auto sweeps = without_walls(perfect_sweeps(), {3, 2});
  turn_wall(sweeps, 1, rad_from_deg(1.0));
  for (AlphaSweep& sweep : sweeps) sweep.walls[1].azimuth_sigma_rad = rad_from_deg(0.04);
  const AlphaFit fit = fitted(sweeps);
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad - rad_from_deg(0.5), rad_from_deg(0.1));
  EXPECT_GT(fit.sigma_rad, rad_from_deg(0.4));
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
      plane = turned(plane, rad_from_deg(wall_noise_deg(random)));
      plane.azimuth_sigma_rad = rad_from_deg(0.02);
    }
  }
  return sweeps;
}

TEST(Alpha, SigmaIsHonestForFewSweepsAndForMany) {
  for (const std::size_t count : {1U, 2U, 3U, 5U, 20U}) {
    AlphaOptions options;
    options.least_sweeps = 1;
    std::mt19937 random(static_cast<unsigned>(count));
    double squares = 0.0;
    int within = 0;
    int doubted = 0;
    constexpr int kRuns = 300;
    for (int run = 0; run < kRuns; ++run) {
      const AlphaFit fit = fitted(noisy_sweeps(count, 0.08, random), options);
      const double errors_in_sigmas = (fit.alpha_rad - kAlphaRad) / fit.sigma_rad;
      squares += errors_in_sigmas * errors_in_sigmas;
      if (std::abs(errors_in_sigmas) < 1.0) ++within;
      if (!fit.model_holds) ++doubted;
    }
    EXPECT_GT(std::sqrt(squares / kRuns), 0.8) << count;
    EXPECT_LT(std::sqrt(squares / kRuns), 1.2) << count;
    EXPECT_GT(within, 0.60 * kRuns) << count;
    EXPECT_LT(within, 0.82 * kRuns) << count;
    EXPECT_LE(doubted, 3) << count;
  }
}

TEST(Alpha, ChiSquareIsAboutItsDegreesOfFreedomWhenTheSigmasAreTrue) {
  std::mt19937 random(9);
  double sum = 0.0;
  for (int run = 0; run < 100; ++run) {
    const AlphaFit fit = fitted(noisy_sweeps(5, 0.08, random));
    EXPECT_EQ(fit.degrees_of_freedom, 16U);  // 20 sightings, 4 angles
    sum += fit.chi_square;
  }
  EXPECT_NEAR(sum / 100, 16.0, 1.7);  // 3 sigmas of the mean
}

TEST(Alpha, ScatterAboveTheSweepsOwnSigmasWidensSigmaAndIsSaid) {
  std::mt19937 random(7);
  auto sweeps = noisy_sweeps(20, 0.3, random);
  for (AlphaSweep& sweep : sweeps) sweep.beta_sigma_rad = rad_from_deg(0.15);
  const AlphaFit fit = fitted(sweeps);
  EXPECT_GT(fit.sigma_rad, rad_from_deg(0.3 / std::sqrt(20.0) * 0.7));
  EXPECT_FALSE(fit.model_holds);
  EXPECT_NE(remarks_of(fit).find("plate's azimuths scatter"), std::string::npos);
}

TEST(Alpha, WallsThatMoveBetweenTheSweepsAreSaid) {
  std::mt19937 random(8);
  auto sweeps = noisy_sweeps(20, 0.08, random);
  for (AlphaSweep& sweep : sweeps) {
    for (Plane& plane : sweep.walls) plane.azimuth_sigma_rad = rad_from_deg(0.01);
  }
  const AlphaFit fit = fitted(sweeps);
  EXPECT_FALSE(fit.model_holds);
  EXPECT_NE(remarks_of(fit).find("walls' angles scatter"), std::string::npos) << remarks_of(fit);
}

// A sharp sweep counts for more: five of mode 1 and one of mode 7.
TEST(Alpha, SweepsOfAllModesMixByTheirSigmas) {
  std::mt19937 random(3);
  double squares = 0.0;
  double foretold_rad = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    auto sweeps = noisy_sweeps(5, 0.08, random);
    sweeps.push_back(noisy_sweeps(1, 0.016, random)[0]);
    const AlphaFit fit = fitted(sweeps);
    squares += std::pow(fit.alpha_rad - kAlphaRad, 2);
    foretold_rad = fit.sweeps_sigma_rad;
  }
  EXPECT_LT(std::sqrt(squares / kRuns), rad_from_deg(0.021));
  EXPECT_LT(foretold_rad, rad_from_deg(0.025));
}

TEST(Alpha, WallsOutOfSquareLimitSigmaHoweverManySweeps) {
  std::vector<AlphaSweep> sweeps(400, perfect_sweep(0.01));
  for (const std::size_t side : {0U, 1U, 2U, 3U}) {
    turn_wall(sweeps, side, rad_from_deg(side % 2 == 0 ? 0.06 : -0.06));
  }
  const AlphaFit fit = fitted(sweeps);
  EXPECT_GT(fit.sigma_rad, rad_from_deg(0.02));
  EXPECT_FALSE(more_sweeps_for(fit, rad_from_deg(0.02)));
}

TEST(Alpha, AsManyMoreSweepsAsItSaysBringTheWantedSigma) {
  const std::vector<AlphaSweep> few(5, perfect_sweep(0.01));
  const AlphaFit fit = fitted(few);
  for (const double wanted_deg : {0.05, 0.02, 0.011}) {
    const auto more = more_sweeps_for(fit, rad_from_deg(wanted_deg));
    ASSERT_TRUE(more);
    const std::vector<AlphaSweep> enough(5 + *more, perfect_sweep(0.01));
    const std::vector<AlphaSweep> too_few(4 + *more, perfect_sweep(0.01));
    EXPECT_LE(fitted(enough).sigma_rad, rad_from_deg(wanted_deg) * (1 + 1e-9));
    EXPECT_GT(fitted(too_few).sigma_rad, rad_from_deg(wanted_deg));
  }
  EXPECT_EQ(more_sweeps_for(fit, fit.sigma_rad), 0U);
}

TEST(Alpha, TooFewSweepsAreRefusedUnlessFewerAreAllowed) {
  expect_refused({}, {"0 sweeps", "3 needed"});
  const std::vector<AlphaSweep> two = {perfect_sweep(0.0), perfect_sweep(0.1)};
  expect_refused(two, {"2 sweeps", "3 needed"});
  AlphaOptions options;
  options.least_sweeps = 1;
  EXPECT_NEAR(fitted(two, options).alpha_rad, kAlphaRad, 1e-9);
  const AlphaFit of_one = fitted({two[1]}, options);
  EXPECT_NEAR(of_one.alpha_rad, kAlphaRad, 1e-9);
  EXPECT_GT(of_one.sigma_rad, rad_from_deg(0.13));
  EXPECT_EQ(of_one.degrees_of_freedom, 0U);
  EXPECT_NE(remarks_of(of_one).find("one sweep"), std::string::npos);
  options.least_sweeps = 0;
  expect_refused({}, {"0 sweeps", "1 needed"}, options);
}

TEST(Alpha, AWallThatOneSweepMissedIsTakenFromTheOthers) {
  auto sweeps = perfect_sweeps();
  sweeps[2].walls.erase(sweeps[2].walls.begin());
  const AlphaFit fit = fitted(sweeps);
  EXPECT_NEAR(fit.alpha_rad, kAlphaRad, 1e-9);
  EXPECT_EQ(fit.degrees_of_freedom, 11U);  // 15 sightings, 4 angles
}

TEST(Alpha, ASweepWithoutWallsIsLeftOutByName) {
  auto sweeps = perfect_sweeps();
  sweeps[2].walls.clear();
  const AlphaFit fit = fitted(sweeps);
  EXPECT_EQ(fit.sweeps_used, 3U);
  EXPECT_NE(remarks_of(fit).find("sweep 3"), std::string::npos);
  sweeps[1].walls.clear();
  expect_refused(sweeps, {"walls"});
}

TEST(Alpha, ARoomTooFarOffTheFrontIsRefused) {
  expect_refused(perfect_sweeps(rad_from_deg(27.0)), {"0 of 4", "20 deg", "yaw"});
  // Where it is nearly that far, the user is asked.
  const AlphaFit fit = fitted(perfect_sweeps(rad_from_deg(9.0)));
  EXPECT_NE(remarks_of(fit).find("does the rig stand square"), std::string::npos);
}

// As plate_yawed_room of the cases: no two walls that are side by side are square.
TEST(Alpha, ARoomThatIsNowhereSquareIsRefused) {
  auto sweeps = perfect_sweeps();
  turn_wall(sweeps, 0, rad_from_deg(9.0));
  turn_wall(sweeps, 1, rad_from_deg(-7.0));
  turn_wall(sweeps, 2, rad_from_deg(1.0));
  expect_refused(sweeps, {"2 of 4 walls", "back by", "right by"});
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
