#include "calibration/seam.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "calibration/transform_cloud.hpp"
#include "tests/calibration/plate_case.hpp"
#include "tests/calibration/simulated_sweep.hpp"

namespace swivel {
namespace {

// Square or skewed, bare or furnished, the rig standing any way in it.
sim::RoomOptions some_room(std::mt19937& random) {
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  sim::RoomOptions room;
  if (random() % 3 != 0) room.yaw_deg = 180.0 * share(random);
  if (random() % 2 == 0) room.front_skew_deg = 8.0 * share(random);
  if (random() % 3 == 0) room.furniture.clear();
  return room;
}

SimulatedSweep some_sweep(int mode, unsigned seed) {
  std::mt19937 random(seed);
  SimulatedSweep sweep;
  sweep.mode = mode;
  sweep.seed = seed;
  sweep.start_deg = std::uniform_real_distribution<double>(-3.0, 3.0)(random);
  sweep.world.room = some_room(random);
  sweep.lidar.noise_mm = seed % 2 == 0 ? 13.0 : 20.0;
  sweep.lidar.spot_radius_mm = seed % 6 == 0 ? 4.0 : 0.0;
  return sweep;
}

// Over many sweeps: how far off, and by how many sigma.
struct SeamErrors {
  double squares_deg2 = 0.0;
  double sigma_squares = 0.0;
  int known = 0;
  int unknown = 0;
  int alarms = 0;

  void add(const SeamEstimate& seam, double true_deg) {
    alarms += seam_is_open(seam) ? 1 : 0;
    if (std::isnan(seam.further_rad)) {
      EXPECT_NE(seam.reason, "");
      ++unknown;
      return;
    }
    EXPECT_GT(seam.walls, 0U);
    const double error_deg = deg_from_rad(seam.further_rad) - true_deg;
    squares_deg2 += error_deg * error_deg;
    sigma_squares += std::pow(error_deg / deg_from_rad(seam.sigma_rad), 2);
    ++known;
  }
  double rms_deg() const { return std::sqrt(squares_deg2 / known); }
  double rms_sigmas() const { return std::sqrt(sigma_squares / known); }
};

// The slow modes are many lines to cast, and differ the least.
struct SweepsOfMode {
  int mode;
  unsigned sweeps;
};
constexpr SweepsOfMode kTwoHundred[] = {{1, 120}, {2, 60}, {3, 14}, {4, 3}, {5, 1}, {6, 1}, {7, 1}};

TEST(Seam, IsClosedWhenTheShaftTurnedAsToldAndItsSigmaIsHonest) {
  SeamErrors all;
  for (const SweepsOfMode& tried : kTwoHundred) {
    SeamErrors errors;
    for (unsigned seed = 0; seed < tried.sweeps; ++seed) {
      const SeamEstimate seam = measure_seam(raw_cloud(some_sweep(tried.mode, seed)));
      errors.add(seam, 0.0);
      all.add(seam, 0.0);
    }
    RecordProperty("rms_mdeg_" + std::to_string(tried.mode), std::lround(errors.rms_deg() * 1e3));
    EXPECT_LT(errors.rms_deg(), tried.mode == 1 ? 0.1 : 0.06) << tried.mode;
  }
  EXPECT_EQ(all.alarms, 0);
  EXPECT_LE(all.unknown, 16);  // a corner stands at both seams
  EXPECT_GT(all.rms_sigmas(), 0.7);
  EXPECT_LT(all.rms_sigmas(), 1.3);
}

TEST(Seam, SaysHowManyDegreesWereLostBetweenTheWindows) {
  for (const SweepsOfMode& tried :
       {SweepsOfMode{1, 24}, {2, 12}, {3, 6}, {4, 3}, {5, 2}, {6, 1}, {7, 1}}) {
    for (unsigned seed = 0; seed < tried.sweeps; ++seed) {
      SimulatedSweep sweep = some_sweep(tried.mode, 300 + seed);
      sweep.further_deg = std::array<double, 4>{-1.0, -2.5, 1.5, -9.0}.at(seed % 4);
      sweep.at_share = 0.3 + 0.4 * seed / tried.sweeps;
      const SeamEstimate seam = measure_seam(raw_cloud(sweep));
      if (std::isnan(seam.further_rad)) continue;
      EXPECT_TRUE(seam_is_open(seam)) << tried.mode << " " << seed;
      EXPECT_NEAR(deg_from_rad(seam.further_rad), sweep.further_deg,
                  0.2 * std::abs(sweep.further_deg))
          << tried.mode << " " << seed;
    }
  }
}

TEST(Seam, SaysSoToWhenTheyWereLostInsideAWindow) {
  for (const double at_share : {0.08, 0.15, 0.22, 0.8, 0.87, 0.92}) {
    for (const double yaw_deg : {0.0, 20.0, -40.0}) {
      SimulatedSweep sweep;
      sweep.mode = 3;
      sweep.further_deg = -1.5;
      sweep.at_share = at_share;
      sweep.world.room.yaw_deg = yaw_deg;
      const SeamEstimate seam = measure_seam(raw_cloud(sweep));
      EXPECT_TRUE(seam_is_open(seam)) << at_share << " " << yaw_deg;
      EXPECT_NEAR(deg_from_rad(seam.further_rad), -1.5, 0.3)
          << at_share << " " << yaw_deg << " " << deg_from_rad(seam.sigma_rad);
    }
  }
}

// What errs together within a line or along a wall, as noise of single beams does not.
void push_out(OrganisedCloud& cloud, std::size_t line, std::size_t beam, double by_m) {
  CloudPoint& point = cloud.line(line)[beam];
  const auto longer = 1.0F + static_cast<float>(by_m) / std::hypot(point.x_m, point.y_m);
  point.x_m *= longer;
  point.y_m *= longer;
}

TEST(Seam, LinesThatErrAndWavyWallsWidenItsSigma) {
  std::mt19937 random(5);
  std::normal_distribution<double> line_error_m(0.0, 0.003);
  SeamErrors lines;
  SeamErrors waves;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const OrganisedCloud cloud = raw_cloud(some_sweep(1 + static_cast<int>(seed % 3), seed));
    OrganisedCloud shaken = cloud;
    OrganisedCloud wavy = cloud;
    for (std::size_t line = 0; line < cloud.lines; ++line) {
      const double by_m = line_error_m(random);
      for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
        const CloudPoint& point = cloud.line(line)[beam];
        const double along_m = static_cast<double>(point.x_m + point.y_m);
        push_out(shaken, line, beam, by_m);
        push_out(wavy, line, beam, 0.008 * std::sin(2.0 * kPi * along_m));
      }
    }
    lines.add(measure_seam(shaken), 0.0);
    waves.add(measure_seam(wavy), 0.0);
  }
  EXPECT_EQ(lines.alarms + waves.alarms, 0);
  EXPECT_LT(lines.rms_sigmas(), 1.4);
  EXPECT_LT(waves.rms_sigmas(), 1.15);  // 1.23 if neighbours counted as independent
  EXPECT_LT(lines.rms_deg(), 0.3);
}

TEST(Seam, DoesNotDependOnWhereTheSweepBegan) {
  SimulatedSweep sweep = some_sweep(2, 4);
  sweep.further_deg = -2.0;
  OrganisedCloud cloud = raw_cloud(sweep);
  const SeamEstimate seam = measure_seam(cloud);
  for (const double angle_deg : {70.0, 180.0, -45.0}) {
    OrganisedCloud turned = cloud;
    transform_cloud(
        Eigen::Isometry3d(Eigen::AngleAxisd(rad_from_deg(angle_deg), Eigen::Vector3d::UnitZ())),
        turned);
    const SeamEstimate same = measure_seam(turned);
    EXPECT_NEAR(same.further_rad, seam.further_rad, rad_from_deg(0.01)) << angle_deg;
    EXPECT_NEAR(same.sigma_rad, seam.sigma_rad, rad_from_deg(0.01)) << angle_deg;
  }
}

TEST(Seam, IsClosedOnRecordingsOfAnIndependentSimulator) {
  for (const std::string name : {"clean", "real", "rough"}) {
    const PlateCase plate_case = load_plate_case(SWIVEL_TEST_DATA "/plate_" + name + "_mode1");
    const SeamEstimate seam = measure_seam(plate_case.sweeps.at(0).cloud);
    EXPECT_FALSE(seam_is_open(seam)) << name;
    EXPECT_LT(std::abs(deg_from_rad(seam.further_rad)), 0.15) << name;
    EXPECT_EQ(seam.walls, 2U) << name;
  }
}

// A ramp of six lines, not a jump: how much is only roughly told.
TEST(Seam, IsOpenWhenMotorAndLidarStartTogether) {
  const PlateCase plate_case = load_plate_case(SWIVEL_TEST_DATA "/plate_naive_mode1");
  const SeamEstimate seam = measure_seam(plate_case.sweeps.at(0).cloud);
  EXPECT_TRUE(seam_is_open(seam));
  EXPECT_LT(deg_from_rad(seam.further_rad), -3.0);
}

TEST(Seam, WithoutWallsItIsNotKnownAndSaysWhy) {
  OrganisedCloud fog(80, 400);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place_m(-5.0F, 5.0F);
  for (CloudPoint& point : fog.points) {
    point = {place_m(random), place_m(random), place_m(random), 0.0F};
  }
  OrganisedCloud infinite(80, 400);
  for (CloudPoint& point : infinite.points) point = {INFINITY, -INFINITY, INFINITY, 0.0F};
  OrganisedCloud one_place(80, 400);
  for (CloudPoint& point : one_place.points) point = {1.0F, 2.0F, 3.0F, 0.0F};
  for (const OrganisedCloud& cloud : {OrganisedCloud(), OrganisedCloud(1, 1),
                                      OrganisedCloud(80, 400), fog, infinite, one_place}) {
    const SeamEstimate seam = measure_seam(cloud);
    EXPECT_TRUE(std::isnan(seam.further_rad)) << seam.further_rad << " " << seam.sigma_rad;
    EXPECT_TRUE(std::isnan(seam.sigma_rad));
    EXPECT_EQ(seam.walls, 0U);
    EXPECT_NE(seam.reason, "");
    EXPECT_FALSE(seam_is_open(seam));
  }
}

TEST(Seam, OpensBeyondBothLimitsOfTheAlarm) {
  const auto seam = [](double further_deg, double sigma_deg) {
    return SeamEstimate{rad_from_deg(further_deg), rad_from_deg(sigma_deg), 2, ""};
  };
  EXPECT_FALSE(seam_is_open(seam(-0.49, 0.01)));
  EXPECT_TRUE(seam_is_open(seam(-0.51, 0.01)));
  EXPECT_TRUE(seam_is_open(seam(0.51, 0.01)));
  EXPECT_FALSE(seam_is_open(seam(2.0, 0.41)));
  EXPECT_TRUE(seam_is_open(seam(2.0, 0.39)));
}

}  // namespace
}  // namespace swivel
