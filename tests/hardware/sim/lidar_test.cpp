// The simulated room as the lidar sees it, against distances worked out by hand and against
// recordings of a simulator that is another program in another language.
#include "hardware/sim/lidar.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <vector>

namespace swivel::sim {
namespace {

constexpr double kBeamPeriodNs = 25.0e6 / 1440.0;

LidarOptions exact_lidar() {
  LidarOptions lidar;
  lidar.noise_mm = 0.0;
  lidar.dropout_rate = 0.0;
  return lidar;
}

WorldOptions empty_room() {
  WorldOptions world;
  world.room.furniture.clear();
  world.plate.present = false;
  return world;
}

LineReading standing_line(const WorldOptions& options, const LidarOptions& lidar, double phi_deg,
                          std::uint64_t seed = 1, std::uint64_t line = 0) {
  const World world(options);
  return Lidar(lidar, world, seed).cast_line({line, 0, kBeamPeriodNs}, [phi_deg](std::int64_t) {
    return phi_deg * kRadPerDeg;
  });
}

int range(double phi_deg, int step) {
  return standing_line(empty_room(), exact_lidar(), phi_deg)
      .ranges_mm[static_cast<std::size_t>(step)];
}

// Steps 180, 540, 720 and 900 look to -90, 0, 45 and 90 deg.
TEST(Lidar, MeetsTheWallsWhereTheyStand) {
  EXPECT_EQ(range(0, 900), 2400);  // level, to the left wall
  EXPECT_EQ(range(0, 180), 2100);
  EXPECT_EQ(range(90, 900), 2600);  // turned a quarter to the left: to the back
  EXPECT_EQ(range(90, 180), 3400);
  EXPECT_EQ(range(30, 540), 1850);  // straight up
  EXPECT_EQ(range(30, 720), 2616);  // 1850 / cos 45
  EXPECT_EQ(range(0, 60), 1900);    // 950 / cos 60, to the floor
}

// The lidar's centre is 13.9 mm from the axis: (12.038, 6.95) at 30 deg.
TEST(Lidar, StandsOnItsLeverArm) {
  EXPECT_EQ(range(30, 900), 2763);   // (2400 - 6.95) / cos 30
  EXPECT_EQ(range(30, 180), 2433);   // (2100 + 6.95) / cos 30
  EXPECT_EQ(range(200, 900), 2230);  // (2100 - 4.754) / cos 20
  EXPECT_EQ(range(300, 900), 3918);  // (3400 - 6.95) / cos 30
}

LidarOptions mounted(const Vector3& xyz_mm, const Vector3& rpy_deg) {
  LidarOptions lidar = exact_lidar();
  lidar.mounting = {xyz_mm, rpy_deg};
  return lidar;
}

int range(const LidarOptions& lidar, double phi_deg, int step) {
  return standing_line(empty_room(), lidar, phi_deg).ranges_mm[static_cast<std::size_t>(step)];
}

TEST(Lidar, IsMountedAsItsPlacementSays) {
  EXPECT_EQ(range(mounted({}, {10, 0, 0}), 0, 720), 2258);   // 1850 / cos 35: lifted
  EXPECT_EQ(range(mounted({}, {0, 80, 0}), 0, 540), 3452);   // to the front: 3400 / sin 80
  EXPECT_EQ(range(mounted({}, {0, 0, 60}), 0, 900), 3002);   // to the back: 2600 / sin 60
  EXPECT_EQ(range(mounted({}, {90, 0, 90}), 0, 540), 3400);  // rolled first, then turned
  EXPECT_EQ(range(mounted({100, 200, 300}, {}), 0, 900), 2200);
  EXPECT_EQ(range(mounted({100, 200, 300}, {}), 90, 900), 2400);  // at (-200, 100)
  EXPECT_EQ(range(mounted({100, 200, 300}, {}), 90, 540), 1550);
}

// The tilting rig of the recordings, as its driver has it: at tilt t the sensor stands at
// (R sin t, 0, R cos t), R = 80 mm, and is turned by t about Y; beams of a level sensor leave
// along (cos theta, sin theta, 0).
TEST(Lidar, NodsAboutAnAxisThatLies) {
  LidarOptions lidar = mounted({0, -80, 0}, {90, 0, 90});
  lidar.axis.rpy_deg = {-90, 0, 0};
  EXPECT_EQ(range(lidar, 0, 540), 3400);
  EXPECT_EQ(range(lidar, 0, 900), 2400);
  EXPECT_EQ(range(lidar, 15, 540), 3499);  // (3400 - 80 sin 15) / cos 15
  EXPECT_EQ(range(lidar, 50, 540), 1307);  // to the floor: (950 + 80 cos 50) / sin 50
  lidar.axis.xyz_mm = {100, 0, 20};
  EXPECT_EQ(range(lidar, 50, 540), 1333);
}

TEST(Lidar, FiresEachBeamAtItsOwnInstant) {
  const World world(empty_room());
  std::vector<std::int64_t> times_ns;
  Lidar(exact_lidar(), world, 1).cast_line({0, 1000, kBeamPeriodNs}, [&](std::int64_t time_ns) {
    times_ns.push_back(time_ns);
    return 0.0;
  });
  ASSERT_EQ(times_ns.size(), 1081U);
  EXPECT_EQ(times_ns.front(), 1000);
  EXPECT_EQ(times_ns.back(), 1000 + 18'750'000);
}

TEST(Lidar, BiasTurnsTheBeamsTowardsLaterSteps) {
  LidarOptions biased = exact_lidar();
  biased.bias_deg = 45.0;
  EXPECT_EQ(standing_line(empty_room(), biased, 30).ranges_mm[720], 2763);
}

TEST(Lidar, SkewAndYawOfTheRoom) {
  WorldOptions world = empty_room();
  world.room.yaw_deg = 10.0;
  EXPECT_EQ(standing_line(world, exact_lidar(), 100).ranges_mm[180], 3400);  // to 10 deg
  world.room.front_skew_deg = 5.0;
  EXPECT_EQ(standing_line(world, exact_lidar(), 105).ranges_mm[180], 3387);  // 3400 cos 5
}

// The range on a level plate is depth / -cos theta at any azimuth (Yuan 2021, figure 6).
std::vector<int> plate_steps(const WorldOptions& options, double phi_deg, int last_step) {
  LidarOptions lidar = exact_lidar();
  lidar.sensor.last_step = last_step;
  const LineReading line = standing_line(options, lidar, phi_deg);
  std::vector<int> steps;
  for (int step = 0; step <= last_step; ++step) {
    const double theta_rad = (step - 540) * 0.25 * kRadPerDeg;
    const double expected_mm = 60.935 / -std::cos(theta_rad);
    const bool near = expected_mm > 0.0 && expected_mm < 500.0;
    if (near && std::abs(line.ranges_mm[static_cast<std::size_t>(step)] - expected_mm) < 1.0) {
      steps.push_back(step);
    }
  }
  return steps;
}

// By hand: the nearest beams are those at 135 deg, 62.5 mm out; the right angle is 110.75 mm
// out, seen past the lever arm at atan(109.87 / 60.935) = 60.99 deg from straight down,
// which is 63.96 steps on.
TEST(Lidar, SeesThePlateWithOneEndOfItsFan) {
  const WorldOptions world;
  std::set<int> low;
  std::set<int> high;
  for (double phi_deg = world.plate.alpha_deg + 70.0; phi_deg < 140.0; phi_deg += 0.1) {
    for (const int step : plate_steps(world, phi_deg, 1080)) low.insert(step);
    for (const int step : plate_steps(world, phi_deg - 180.0, 1080)) high.insert(step);
  }
  ASSERT_FALSE(low.empty() || high.empty());
  EXPECT_GE(low.size(), 64U);
  EXPECT_LE(low.size(), 71U);
  EXPECT_EQ(*low.begin(), 0);
  EXPECT_EQ(*low.rbegin(), 63);
  EXPECT_EQ(*high.begin(), 1017);
  EXPECT_EQ(*high.rbegin(), 1080);
  EXPECT_TRUE(plate_steps(world, world.plate.alpha_deg, 1080).empty());
  WorldOptions bare = world;
  bare.plate.present = false;
  EXPECT_TRUE(plate_steps(bare, world.plate.alpha_deg + 90.0, 1080).empty());
}

// The plate's middle line is its line of symmetry: at each radius the azimuths seen average
// to alpha.
TEST(Lidar, ThePlateLiesAroundAlpha) {
  WorldOptions world;
  world.plate.alpha_deg = 33.0;
  double sum_deg = 0.0;
  int count = 0;
  for (double phi_deg = 33.0; phi_deg < 213.0; phi_deg += 0.05) {
    for (const int step : plate_steps(world, phi_deg, 80)) {
      const double from_below_rad = (180.0 - (540 - step) * 0.25) * kRadPerDeg;
      const double out_mm = 60.935 * std::tan(from_below_rad);
      sum_deg += phi_deg - 90.0 + std::atan2(13.9, out_mm) / kRadPerDeg;
      ++count;
    }
  }
  EXPECT_GT(count, 10000);
  EXPECT_NEAR(sum_deg / count, 33.0, 0.01);
}

// At 90 mm out it is seen past the lever arm: asin(13.9 / 90) = 8.9 deg before its azimuth.
TEST(Lidar, ClutterIsInTheRing) {
  WorldOptions world;
  world.ring_clutter.present = true;
  const double phi_deg = world.ring_clutter.azimuth_deg + 90.0 - 8.9;
  const auto clean = standing_line(WorldOptions{}, exact_lidar(), phi_deg);
  const auto cluttered = standing_line(world, exact_lidar(), phi_deg);
  int nearer = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    nearer += cluttered.ranges_mm[i] < clean.ranges_mm[i] ? 1 : 0;
  }
  EXPECT_GT(nearer, 5);
}

TEST(Lidar, SameSeedAndLineGiveTheSameNoise) {
  const auto first = standing_line(WorldOptions{}, LidarOptions{}, 10, 7, 3);
  EXPECT_EQ(standing_line(WorldOptions{}, LidarOptions{}, 10, 7, 3).ranges_mm, first.ranges_mm);
  EXPECT_EQ(standing_line(WorldOptions{}, LidarOptions{}, 10, 7, 3).intensities, first.intensities);
  EXPECT_NE(standing_line(WorldOptions{}, LidarOptions{}, 10, 7, 4).ranges_mm, first.ranges_mm);
  EXPECT_NE(standing_line(WorldOptions{}, LidarOptions{}, 10, 8, 3).ranges_mm, first.ranges_mm);
}

TEST(Lidar, NoiseHasTheSizeAskedFor) {
  LidarOptions noisy = exact_lidar();
  noisy.noise_mm = 20.0;
  double squares = 0.0;
  constexpr int kLines = 50;
  for (std::uint64_t line = 0; line < kLines; ++line) {
    const double error = standing_line(empty_room(), noisy, 0, 1, line).ranges_mm[900] - 2400.0;
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / kLines), 20.0, 6.0);
}

TEST(Lidar, SaysItsCodesForTooNearTooFarAndLost) {
  WorldOptions far = empty_room();
  far.room.left_mm = 30001.0;
  EXPECT_EQ(standing_line(far, exact_lidar(), 0).ranges_mm[900], SensorModel().no_return);
  LidarOptions near = exact_lidar();
  near.range_bias_mm = -2380.0;
  EXPECT_EQ(standing_line(empty_room(), near, 0).ranges_mm[900], SensorModel().too_near);
  LidarOptions blind = exact_lidar();
  blind.dropout_rate = 1.0;
  const auto line = standing_line(empty_room(), blind, 0);
  EXPECT_EQ(line.ranges_mm[900], SensorModel().no_return);
  EXPECT_EQ(line.intensities[900], 0);
}

TEST(Lidar, FanAndLimitsAreThoseOfTheSensor) {
  LidarOptions urg = exact_lidar();
  urg.sensor = sensor_model("URG-04LX").value();
  std::vector<std::int64_t> times_ns;
  WorldOptions options = empty_room();
  options.room.front_mm = 5700.0;
  const World world(options);
  const LineReading line = Lidar(urg, world, 1).cast_line({0, 1000, 1e5}, [&](std::int64_t time) {
    times_ns.push_back(time);
    return 90.0 * kRadPerDeg;
  });
  EXPECT_EQ(line.ranges_mm.size(), 682U);
  EXPECT_EQ(line.intensities.size(), 682U);
  EXPECT_EQ(times_ns.front(), 1000);  // of its first step, 44
  EXPECT_EQ(times_ns.back(), 1000 + 68'100'000);
  EXPECT_EQ(line.ranges_mm[384 - 44], 1850);  // straight up
  EXPECT_EQ(line.ranges_mm[640 - 44], 2600);  // 90 deg
  EXPECT_EQ(line.ranges_mm[128 - 44], 0);     // the front wall is beyond 5.6 m
}

TEST(Lidar, SquareSurfacesShineBrighterThanGrazedOnes) {
  const auto line = standing_line(empty_room(), exact_lidar(), 0);
  EXPECT_GT(line.intensities[900], 1.5 * line.intensities[740]);  // the same wall at 50 deg
}

TEST(Lidar, SpotMixesPixelsAtEdgesOnly) {
  LidarOptions spot = exact_lidar();
  spot.spot_radius_mm = 4.0;
  spot.mixed_pixel_rate = 1.0;
  const auto sharp = standing_line(WorldOptions{}, exact_lidar(), 119.36);
  int between = 0;
  int apart = 0;
  const auto line = standing_line(WorldOptions{}, spot, 119.36);
  for (std::size_t i = 0; i < line.ranges_mm.size(); ++i) {
    const bool mixed = i > 0 && line.ranges_mm[i] > 140 && line.ranges_mm[i] < 1000;
    between += mixed ? 1 : 0;
    apart += std::abs(line.ranges_mm[i] - sharp.ranges_mm[i]) > 30 ? 1 : 0;
  }
  EXPECT_GT(between, 0);
  EXPECT_LT(apart, 40);
}

TEST(World, RefusesARigOutsideTheRoom) {
  WorldOptions world;
  world.room.front_mm = -100.0;
  EXPECT_THROW(World{world}, std::invalid_argument);
}

std::vector<std::uint16_t> recorded_ranges() {
  std::ifstream file(SWIVEL_TEST_DATA "/plate_clean_mode1/ranges.u16", std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint16_t> ranges;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto low = static_cast<unsigned char>(bytes[i]);
    const auto high = static_cast<unsigned char>(bytes[i + 1]);
    ranges.push_back(static_cast<std::uint16_t>(low | (high << 8)));
  }
  return ranges;
}

// truth.csv: alpha 29.757612, phi_start 3.380332, 180 deg/s, period 25 ms; an empty room like
// ours; noise 13 mm and nothing else.
TEST(Lidar, AgreesWithAnIndependentSimulatorOfTheRig) {
  WorldOptions options;
  options.room.furniture.clear();
  options.plate.alpha_deg = 29.75761224313253;
  const World world(options);
  const Lidar lidar(exact_lidar(), world, 1);
  const auto recorded = recorded_ranges();
  ASSERT_EQ(recorded.size(), 40U * 1081U);
  double squares = 0.0;
  double sum = 0.0;
  int far_off = 0;
  for (std::size_t line = 0; line < 40; ++line) {
    const auto start_ns = static_cast<std::int64_t>(line) * 25'000'000;
    const auto cast = lidar.cast_line({line, start_ns, kBeamPeriodNs}, [](std::int64_t time_ns) {
      return (3.380332375 + 180e-9 * static_cast<double>(time_ns)) * kRadPerDeg;
    });
    for (std::size_t beam = 0; beam < 1081; ++beam) {
      const double error = cast.ranges_mm[beam] - double{1} * recorded[line * 1081 + beam];
      far_off += std::abs(error) > 80.0 ? 1 : 0;
      if (std::abs(error) > 80.0) continue;
      sum += error;
      squares += error * error;
    }
  }
  const double count = 40.0 * 1081.0 - far_off;
  EXPECT_LE(far_off, 5);  // a beam within a rounding of the plate's edge
  EXPECT_NEAR(sum / count, 0.0, 0.3);
  EXPECT_NEAR(std::sqrt(squares / count), 13.0, 0.2);
}

}  // namespace
}  // namespace swivel::sim
