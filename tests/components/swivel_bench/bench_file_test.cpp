#include "components/swivel_bench/bench_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "components/common/rig_file.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/swivel_bench/bench_options.hpp"
#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

using ::testing::HasSubstr;

std::string written(const std::string& text) {
  std::string path = own_path("bench_file_test.yaml");
  std::ofstream(path) << text;
  return path;
}

sim::BenchOptions loaded(const std::string& text) {
  const std::string path = written(text);
  try {
    const sim::BenchOptions options = load_bench_file(path);
    std::remove(path.c_str());
    return options;
  } catch (...) {
    std::remove(path.c_str());
    throw;
  }
}

std::string refusal_of(const std::string& text) {
  try {
    loaded(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(BenchFile, ShippedFileSaysWhatTheDefaultsAre) {
  const sim::BenchOptions shipped = load_bench_file(SWIVEL_CONFIG "/benches/yuan.yaml");
  const sim::BenchOptions defaults;
  EXPECT_EQ(shipped.seed, defaults.seed);
  EXPECT_EQ(shipped.world.plate.alpha_deg, defaults.world.plate.alpha_deg);
  EXPECT_EQ(shipped.world.plate.depth_mm, defaults.world.plate.depth_mm);
  EXPECT_EQ(shipped.world.room.front_mm, defaults.world.room.front_mm);
  EXPECT_EQ(shipped.world.room.furniture.size(), defaults.world.room.furniture.size());
  EXPECT_EQ(shipped.lidar.mounting.xyz_mm.x, defaults.lidar.mounting.xyz_mm.x);
  EXPECT_EQ(shipped.lidar.sensor.product, defaults.lidar.sensor.product);
  EXPECT_EQ(shipped.lidar.sensor.serial_number, defaults.lidar.sensor.serial_number);
  EXPECT_EQ(shipped.lidar.sensor.last_step, defaults.lidar.sensor.last_step);
  EXPECT_EQ(shipped.motor.travel_deg, defaults.motor.travel_deg);
  EXPECT_EQ(shipped.motor.encoder.present, defaults.motor.encoder.present);
  EXPECT_EQ(shipped.lidar.noise_mm, defaults.lidar.noise_mm);
  EXPECT_EQ(shipped.lidar.dropout_rate, defaults.lidar.dropout_rate);
  EXPECT_EQ(shipped.lidar.spot_radius_mm, defaults.lidar.spot_radius_mm);
  EXPECT_EQ(shipped.lidar.divergence_mrad, defaults.lidar.divergence_mrad);
  EXPECT_EQ(shipped.lidar.echo_fraction, defaults.lidar.echo_fraction);
  EXPECT_EQ(shipped.lidar.echo_jitter, defaults.lidar.echo_jitter);
  EXPECT_EQ(shipped.lidar.gain_knee_mm, defaults.lidar.gain_knee_mm);
  EXPECT_EQ(shipped.lidar.echo_merge_mm, defaults.lidar.echo_merge_mm);
  EXPECT_EQ(shipped.lidar.mixed_pixel_rate, defaults.lidar.mixed_pixel_rate);
  EXPECT_EQ(shipped.timing.scan_period_ms, defaults.timing.scan_period_ms);
  EXPECT_EQ(shipped.timing.start_latency_ms, defaults.timing.start_latency_ms);
  EXPECT_EQ(shipped.motor.home_angle_deg, defaults.motor.home_angle_deg);
  EXPECT_EQ(shipped.motor.shaft.steps_per_turn, defaults.motor.shaft.steps_per_turn);
  EXPECT_EQ(shipped.server.port, defaults.server.port);
}

TEST(BenchFile, ReadsEverySection) {
  const sim::BenchOptions bench = load_bench_file(
      written("seed: 9\nroom: {yaw_deg: 3, furniture: {}}\nplate: {present: false}\n"
              "ring_clutter: {present: true}\nlidar: {noise_mm: 5, divergence_mrad: 6}\n"
              "timing: {stamp_origin: rear_centre}\nstepper: {lose_every: 50}\n"
              "server: {chop: true}\n"));
  EXPECT_EQ(bench.seed, 9U);
  EXPECT_EQ(bench.world.room.yaw_deg, 3.0);
  EXPECT_TRUE(bench.world.room.furniture.empty());
  EXPECT_FALSE(bench.world.plate.present);
  EXPECT_TRUE(bench.world.ring_clutter.present);
  EXPECT_EQ(bench.lidar.noise_mm, 5.0);
  EXPECT_EQ(bench.lidar.divergence_mrad, 6.0);
  EXPECT_TRUE(bench.timing.stamp_at_rear_centre);
  EXPECT_EQ(bench.motor.lose_every, 50);
  EXPECT_TRUE(bench.server.misbehaviour.chop);
}

TEST(BenchFile, RefusesWhatItDoesNotKnowWithFileAndLine) {
  EXPECT_THAT(refusal_of("seed: 1\nplate: {alpha: 30}\n"), HasSubstr("bench_file_test.yaml:2"));
  EXPECT_THAT(refusal_of("walls: 4\n"), HasSubstr("walls"));
  EXPECT_THAT(refusal_of("lidar: {noise_mm: -1}\n"), HasSubstr("noise_mm"));
  EXPECT_THAT(refusal_of("lidar: {last_step: 1440}\n"), HasSubstr("less than a turn"));
  EXPECT_THAT(refusal_of("lidar: {model: UST-11}\n"), HasSubstr("is none of"));
  EXPECT_THAT(refusal_of("lidar: {first_step: 1080}\n"), HasSubstr("below last_step"));
  EXPECT_THAT(refusal_of("mounting: {rpy_deg: [1, 2]}\n"), HasSubstr("list of 3"));
  EXPECT_THAT(refusal_of("stepper: {encoder: {latency_max_ms: 0.1}}\n"), HasSubstr("not be below"));
  EXPECT_THAT(refusal_of("stepper: {start_latency_max_ms: 1}\n"), HasSubstr("not be below"));
  EXPECT_THAT(refusal_of("room: {furniture: {box: {top_mm: -5}}}\n"), HasSubstr("above"));
}

sim::BenchOptions parsed(std::vector<std::string> arguments) {
  CLI::App app;
  const BenchCommandLine command_line(app);
  arguments.insert(arguments.begin(), {"--config", SWIVEL_CONFIG "/benches/yuan.yaml"});
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  app.parse(arguments);
  return command_line.options();
}

TEST(BenchCommandLine, WinsOverTheFile) {
  const sim::BenchOptions bench =
      parsed({"--seed", "5", "--noise-mm", "0", "--alpha-deg", "31.5", "--port", "10940",
              "--no-plate", "--close-every", "7", "--truth", "t.csv"});
  EXPECT_EQ(bench.seed, 5U);
  EXPECT_EQ(bench.lidar.noise_mm, 0.0);
  EXPECT_EQ(bench.world.plate.alpha_deg, 31.5);
  EXPECT_EQ(bench.server.port, 10940);
  EXPECT_FALSE(bench.world.plate.present);
  EXPECT_EQ(bench.server.misbehaviour.close_every, 7);
  EXPECT_EQ(bench.truth_path, "t.csv");
}

TEST(BenchCommandLine, TheMountingIsOffByWhatIsAsked) {
  const sim::BenchOptions bench =
      parsed({"--bias-deg", "5", "--mounting-xyz-mm", "1,-2,3", "--mounting-rpy-deg", "0.1,0.2,-3",
              "--serial-number", "H42"});
  EXPECT_EQ(bench.lidar.bias_deg, 5.0);
  EXPECT_EQ(bench.lidar.mounting.xyz_mm.x, 13.9 + 1.0);
  EXPECT_EQ(bench.lidar.mounting.xyz_mm.y, -2.0);
  EXPECT_EQ(bench.lidar.mounting.rpy_deg.x, 0.1);
  EXPECT_EQ(bench.lidar.mounting.rpy_deg.z, -3.0);
  EXPECT_EQ(bench.lidar.sensor.serial_number, "H42");
}

class ShippedRig : public ::testing::TestWithParam<const char*> {};

// What the bench has without being told is what the rig file says.
TEST_P(ShippedRig, HasABenchThatIsBuiltAsDrawn) {
  const std::string name = std::string("/") + GetParam() + ".yaml";
  const sim::BenchOptions bench = load_bench_file(SWIVEL_CONFIG "/benches" + name);
  const RigFile rig = load_rig_file(SWIVEL_CONFIG "/rigs" + name);
  const sim::Pose axis(bench.lidar.axis);
  const sim::Pose mounting(bench.lidar.mounting);
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 2, 3)}) {
    const sim::Vector3 placed = axis.point(mounting.point({p.x(), p.y(), p.z()}));
    const Eigen::Vector3d drawn = rig.geometry.T_base_axis * (rig.geometry.T_axis_lidar * p);
    EXPECT_LT((Eigen::Vector3d(placed.x, placed.y, placed.z) - drawn).norm(), 1e-12);
  }
  ASSERT_TRUE(rig.lidar && rig.stepper);
  EXPECT_EQ(bench.lidar.bias_deg, deg_from_rad(rig.geometry.bias_rad));
  EXPECT_EQ(bench.lidar.sensor.tells_intensities, rig.lidar->intensities);
  EXPECT_NEAR(bench.timing.scan_period_ms, 1e3 * rig.modes.line_period_s, 0.5);
  EXPECT_EQ(bench.motor.home_angle_deg, rig.stepper->home_angle_deg);
  EXPECT_EQ(bench.motor.encoder.present, rig.axis_measured);
  EXPECT_EQ(bench.world.plate.present, rig.plate.has_value());
}

INSTANTIATE_TEST_SUITE_P(Rigs, ShippedRig, ::testing::Values("yuan", "zeng", "tilting"));

TEST(BenchCommandLine, RefusesNonsense) {
  EXPECT_THROW(parsed({"--noise-mm", "-1"}), CLI::ParseError);
  EXPECT_THROW(parsed({"--port", "70000"}), CLI::ParseError);
  EXPECT_THROW(parsed({"--noise"}), CLI::ParseError);
  EXPECT_THROW(parsed({"--mounting-xyz-mm", "1,2"}), CLI::ParseError);
}

}  // namespace
}  // namespace swivel
