// Alpha from whole sweeps of a simulated room: the walls are found in the clouds; beta is the
// truth with the noise that a good estimator leaves (0.08 deg in mode 1, 0.016 in mode 7).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calibration/alpha.hpp"
#include "calibration/line_assembly.hpp"
#include "hardware/sim/lidar.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr double kPlateRad = rad_from_deg(29.36);
constexpr double kPeriodNs = 25e6;
constexpr std::size_t kBeamsOfALine = 1081;
constexpr std::size_t kClouds = 7;

// The sweep of half a turn that begins at phi_rad, in frame O'.
OrganisedCloud swept_cloud(const sim::Lidar& lidar, double phi_rad, std::size_t lines,
                           std::uint64_t first_line) {
  LineAssembler assembler({yuans_rig(), rad_from_deg(-135.0), rad_from_deg(0.25), kBeamsOfALine});
  const double turn_per_line_rad = kPi / static_cast<double>(lines);
  const auto shaft = [&](std::int64_t time_ns) {
    return phi_rad + turn_per_line_rad * static_cast<double>(time_ns) / kPeriodNs;
  };
  OrganisedCloud cloud(lines, kBeamsOfALine);
  for (std::size_t line = 0; line < lines; ++line) {
    const auto number = static_cast<double>(line);
    const sim::LineReading reading = lidar.cast_line(
        {first_line + line, static_cast<std::int64_t>(number * kPeriodNs), kPeriodNs / 1440},
        shaft);
    assembler.assemble({reading.ranges_mm, reading.intensities, 60, 10'000},
                       number * turn_per_line_rad, turn_per_line_rad / 1440, cloud.line(line));
  }
  return cloud;
}

// Beta as it truly is. Clouds are costly: the walls of seven are taken again and again.
std::vector<AlphaSweep> sweeps_in(const sim::RoomOptions& room, std::size_t count,
                                  std::size_t lines) {
  sim::WorldOptions options;
  options.room = room;
  const sim::World world(options);
  const sim::Lidar lidar(sim::LidarOptions(), world, 17);
  std::vector<AlphaSweep> sweeps;
  for (std::size_t sweep = 0; sweep < count; ++sweep) {
    if (sweep >= kClouds) {
      sweeps.push_back(sweeps[sweep - kClouds]);
      continue;
    }
    const double phi_rad = rad_from_deg(0.7 * static_cast<double>(sweep) - 2.0);
    AlphaSweep seen;
    seen.beta_rad = kPlateRad - phi_rad;
    seen.walls = find_walls(swept_cloud(lidar, phi_rad, lines, 1000 * sweep), 8);
    sweeps.push_back(seen);
  }
  return sweeps;
}

sim::RoomOptions cluttered_room() {
  sim::RoomOptions room;
  room.furniture.push_back({400.0, 1950.0, 2.5, 2000.0, 600.0, -950.0, 1300.0, 0.4});    // wardrobe
  room.furniture.push_back({-2300.0, 700.0, 0.4, 500.0, 2200.0, -950.0, 900.0, 0.5});    // shelves
  room.furniture.push_back({1500.0, -1700.0, -3.0, 1800.0, 700.0, -950.0, 300.0, 0.3});  // sofa
  room.furniture.push_back({-900.0, 1700.0, 40.0, 300.0, 450.0, -950.0, 750.0, 0.3});    // someone
  return room;
}

sim::RoomOptions skewed_room() {
  sim::RoomOptions room;
  room.front_skew_deg = 0.5;
  return room;
}

struct Errors {
  double mean_deg = 0.0;
  double rms_deg = 0.0;
  double rms_in_sigmas = 0.0;
};

// Over many draws of beta's noise.
Errors errors_of_alpha(const std::vector<AlphaSweep>& sweeps, double beta_sigma_deg) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise_deg(0.0, beta_sigma_deg);
  Errors errors;
  constexpr int kDraws = 300;
  for (int draw = 0; draw < kDraws; ++draw) {
    auto noisy = sweeps;
    for (AlphaSweep& sweep : noisy) {
      sweep.beta_rad += rad_from_deg(noise_deg(random));
      sweep.beta_sigma_rad = rad_from_deg(beta_sigma_deg);
    }
    const AlphaResult result = fit_alpha(noisy);
    if (!result.fit) {
      ADD_FAILURE() << result.reason;
      return errors;
    }
    const double error_deg = deg_from_rad(result.fit->alpha_rad - kPlateRad);
    errors.mean_deg += error_deg / kDraws;
    errors.rms_deg += error_deg * error_deg / kDraws;
    errors.rms_in_sigmas += std::pow(error_deg / deg_from_rad(result.fit->sigma_rad), 2) / kDraws;
  }
  errors.rms_deg = std::sqrt(errors.rms_deg);
  errors.rms_in_sigmas = std::sqrt(errors.rms_in_sigmas);
  return errors;
}

// A quarter of mode 7's lines: its walls are sharper still.
constexpr std::size_t kLinesOfMode7 = 160;
constexpr std::size_t kLinesOfMode1 = 40;

TEST(AlphaInARoom, FiveSweepsOfMode7AreEnough) {
  for (const auto& room : {sim::RoomOptions(), cluttered_room()}) {
    const Errors errors = errors_of_alpha(sweeps_in(room, 5, kLinesOfMode7), 0.016);
    EXPECT_NEAR(errors.mean_deg, 0.0, 0.005) << room.furniture.size();
    EXPECT_LT(errors.rms_deg, 0.0095);  // 0.0072 of it beta's; 0.015 is two sigmas of that
    EXPECT_LT(errors.rms_in_sigmas, 1.25);
    // In the clutter three walls are heard, and how square they are is known the less.
    EXPECT_GT(errors.rms_in_sigmas, room.furniture.size() > 3 ? 0.4 : 0.8);
  }
}

TEST(AlphaInARoom, TwentySweepsOfMode1AreEnough) {
  for (const auto& room : {sim::RoomOptions(), cluttered_room()}) {
    const Errors errors = errors_of_alpha(sweeps_in(room, 20, kLinesOfMode1), 0.08);
    EXPECT_NEAR(errors.mean_deg, 0.0, 0.008) << room.furniture.size();
    EXPECT_LT(errors.rms_deg, 0.022);  // 0.018 of it beta's
    EXPECT_GT(errors.rms_in_sigmas, 0.7);
    EXPECT_LT(errors.rms_in_sigmas, 1.25);
  }
}

TEST(AlphaInARoom, AWallHalfADegreeAskewHardlyMovesIt) {
  const Errors sharp = errors_of_alpha(sweeps_in(skewed_room(), 5, kLinesOfMode7), 0.016);
  EXPECT_NEAR(sharp.mean_deg, 0.0, 0.012);
  EXPECT_LT(sharp.rms_deg, 0.015);
  const Errors quick = errors_of_alpha(sweeps_in(skewed_room(), 20, kLinesOfMode1), 0.08);
  EXPECT_NEAR(quick.mean_deg, 0.0, 0.015);
  EXPECT_LT(quick.rms_deg, 0.025);
}

TEST(AlphaInARoom, TheRoomsYawIsTakenOutWhereItIsGiven) {
  sim::RoomOptions room = cluttered_room();
  room.yaw_deg = 37.0;
  auto sweeps = sweeps_in(room, 3, kLinesOfMode1);
  for (AlphaSweep& sweep : sweeps) sweep.beta_sigma_rad = rad_from_deg(0.01);
  AlphaOptions options;
  options.room_yaw_rad = rad_from_deg(room.yaw_deg);
  const AlphaResult result = fit_alpha(sweeps, options);
  ASSERT_TRUE(result.fit) << result.reason;
  EXPECT_NEAR(result.fit->alpha_rad, kPlateRad, rad_from_deg(0.01));
}

}  // namespace
}  // namespace swivel
