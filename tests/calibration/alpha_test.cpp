#include "calibration/alpha.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/calibration/room_sweeps.hpp"

namespace swivel {
namespace {

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

// The bench found it: errors of a wall at the other side lay on both sides of 180 deg, and the mean
// of the middle two was 0.
TEST(Alpha, FourSweepsAboutTheDrawnAngleAreNotTurnedRound) {
  std::vector<AlphaSweep> sweeps = perfect_sweeps();
  for (std::size_t i = 0; i < 4; ++i) sweeps[i].beta_rad += rad_from_deg(i % 2 == 0 ? 0.05 : -0.05);
  AlphaOptions options;
  options.initial_alpha_rad = kAlphaRad;
  EXPECT_NEAR(fitted(sweeps, options).alpha_rad, kAlphaRad, 1e-9);
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
