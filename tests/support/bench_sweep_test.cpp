// The sweeps that other tests take for the truth: against figures worked out by hand, and in
// frame O the plate and the walls must lie where the world has them.
#include "tests/support/bench_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/units.hpp"

namespace swivel {
namespace {

BenchSweepOptions exact_sweep(int mode) {
  BenchSweepOptions options;
  options.mode = mode;
  options.lidar.noise_mm = 0.0;
  options.lidar.dropout_rate = 0.0;
  options.world.room = room_of(Room::kSquare);
  options.phi_start_deg = 2.5;
  return options;
}

// A point turned from O' into O by the truth.
struct Place {
  double x_m;
  double y_m;
  double z_m;
};

Place in_o(const BenchSweep& sweep, std::size_t line, std::size_t beam, double more_rad = 0.0) {
  const CloudPoint& point = sweep.cloud.line(line)[beam];
  const double x_m = static_cast<double>(point.x_m);
  const double y_m = static_cast<double>(point.y_m);
  const double turn_rad = sweep.phi_start_rad + more_rad;
  return {std::cos(turn_rad) * x_m - std::sin(turn_rad) * y_m,
          std::sin(turn_rad) * x_m + std::cos(turn_rad) * y_m, static_cast<double>(point.z_m)};
}

double off_the_room_m(const Place& place) {
  const sim::RoomOptions room;
  return std::min({std::abs(place.x_m - m_from_mm(room.front_mm)),
                   std::abs(place.x_m - m_from_mm(room.back_mm)),
                   std::abs(place.y_m - m_from_mm(room.left_mm)),
                   std::abs(place.y_m - m_from_mm(room.right_mm)),
                   std::abs(place.z_m - m_from_mm(room.floor_mm)),
                   std::abs(place.z_m - m_from_mm(room.roof_mm))});
}

TEST(BenchSweep, StandsInTheRoomWhenTurnedByItsTruth) {
  for (const double period_ms : {25.0, 25.04}) {
    BenchSweepOptions options = exact_sweep(1);
    options.world.plate.present = false;
    options.scan_period_ms = period_ms;
    const BenchSweep sweep = make_bench_sweep(options);
    ASSERT_EQ(sweep.cloud.lines, 40U);
    ASSERT_EQ(sweep.cloud.beams, 1081U);
    for (std::size_t line = 0; line < 40; ++line) {
      for (std::size_t beam = 0; beam < 1081; ++beam) {
        ASSERT_LT(off_the_room_m(in_o(sweep, line, beam)), 0.001) << line << " " << beam;
      }
    }
  }
}

TEST(BenchSweep, PlateLiesAtBeta) {
  BenchSweepOptions options = exact_sweep(7);
  options.plate_beams_only = true;
  options.world.plate.alpha_deg = 30.7;
  const BenchSweep sweep = make_bench_sweep(options);
  EXPECT_DOUBLE_EQ(sweep.beta_rad, rad_from_deg(28.2));
  double x_m = 0.0;
  double y_m = 0.0;
  for (const CloudPoint& point : sweep.cloud.points) {
    if (std::abs(point.z_m + 0.060935F) > 0.001F) continue;
    x_m += static_cast<double>(point.x_m);
    y_m += static_cast<double>(point.y_m);
  }
  EXPECT_NEAR(std::atan2(y_m, x_m), sweep.beta_rad, rad_from_deg(0.05));
}

TEST(BenchSweep, LostStepsLeaveWhatComesAfterThemBehind) {
  BenchSweepOptions options = exact_sweep(4);
  options.world.plate.present = false;
  options.lost = {2.0, 90.0};
  const BenchSweep sweep = make_bench_sweep(options);
  for (std::size_t beam = 0; beam < 1081; ++beam) {
    ASSERT_LT(off_the_room_m(in_o(sweep, 98, beam)), 0.001);
    ASSERT_LT(off_the_room_m(in_o(sweep, 104, beam, -rad_from_deg(2.0))), 0.001);
  }
}

TEST(BenchSweep, SeedDrawsStartPlateAndNoise) {
  const BenchSweepOptions one = drawn_sweep(Tier::kReal, 1, 7);
  const BenchSweepOptions other = drawn_sweep(Tier::kReal, 1, 8);
  EXPECT_EQ(one.phi_start_deg, drawn_sweep(Tier::kReal, 1, 7).phi_start_deg);
  EXPECT_NE(one.phi_start_deg, other.phi_start_deg);
  EXPECT_NE(one.world.plate.alpha_deg, other.world.plate.alpha_deg);
  EXPECT_THROW(make_bench_sweep(drawn_sweep(Tier::kReal, 8, 1)), std::out_of_range);
}

}  // namespace
}  // namespace swivel
