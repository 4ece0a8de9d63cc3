#include "hardware/sim/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hardware/sim/motor_axis.hpp"

namespace swivel::sim {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

Move move(double target, double speed) {
  return {target, speed, speed, 0};
}

// 1000 steps at 1000 steps/s with 4000 steps/s^2: 0.25 s ramps of 125 steps, 750 steps between.
TEST(Motion, IsATrapezoid) {
  Motion motion(0);
  motion.add(move(1000, 1000), 4000, 0, 0);
  EXPECT_NEAR(motion.position_at(kSecondNs / 4), 125.0, 1e-6);
  EXPECT_NEAR(motion.speed_at(kSecondNs / 8), 500.0, 1e-6);
  EXPECT_NEAR(motion.speed_at(kSecondNs / 2), 1000.0, 1e-6);
  EXPECT_TRUE(motion.moving(kSecondNs * 5 / 4 - 1000));
  EXPECT_FALSE(motion.moving(kSecondNs * 5 / 4 + 1000));
  EXPECT_EQ(motion.position_at(2 * kSecondNs), 1000.0);
  EXPECT_EQ(motion.speed_at(2 * kSecondNs), 0.0);
}

TEST(Motion, AShortMoveIsATriangle) {
  Motion motion(0);
  motion.add(move(-100, 10000), 1000, 0, 0);
  const double half_s = std::sqrt(0.1);
  const auto half_ns = std::llround(half_s * 1e9);
  EXPECT_NEAR(motion.position_at(half_ns), -50.0, 1e-4);
  EXPECT_NEAR(motion.speed_at(half_ns), -1000 * half_s, 1e-3);
  EXPECT_EQ(motion.position_at(kSecondNs), -100.0);
}

TEST(Motion, NeverJumpsNorTurnsBack) {
  Motion motion(0);
  motion.add(move(300, 1000), 4000, 0, 10'000'000);
  motion.add(move(700, 400), 4000, 50'000'000, 0);
  motion.add(move(-200, 900), 4000, 90'000'000, 0);
  double before = 0.0;
  double highest = 0.0;
  double speed_before = 0.0;
  for (std::int64_t t = 0; t < 4 * kSecondNs; t += 100'000) {
    const double position = motion.position_at(t);
    const double speed = motion.speed_at(t);
    ASSERT_LE(std::abs(position - before), 1000 * 1e-4 + 1e-6) << t;
    ASSERT_LE(std::abs(speed - speed_before), 4000 * 1e-4 + 1e-3) << t;
    highest = std::max(highest, position);
    before = position;
    speed_before = speed;
  }
  EXPECT_NEAR(highest, 700.0, 1e-6);
  EXPECT_EQ(before, -200.0);
}

TEST(Motion, MovesInOneDirectionDoNotStopBetween) {
  Motion motion(0);
  motion.add(move(1000, 1000), 4000, 0, 0);
  motion.add(move(2000, 1000), 4000, 0, 0);
  EXPECT_NEAR(motion.speed_at(std::llround(1.125e9)), 1000.0, 1e-6);
  EXPECT_NEAR(motion.position_at(std::llround(2.25e9) + 1), 2000.0, 1e-6);
}

TEST(Motion, BrakesAndGoesOn) {
  Motion motion(0);
  motion.add(move(1000, 1000), 4000, 0, 0);
  motion.brake(kSecondNs / 2);  // at 375 steps; 125 more to stand still
  EXPECT_NEAR(motion.position_at(kSecondNs), 500.0, 1e-6);
  EXPECT_FALSE(motion.moving(kSecondNs));
  motion.resume(kSecondNs);
  EXPECT_TRUE(motion.moving(kSecondNs + 1));
  EXPECT_EQ(motion.position_at(3 * kSecondNs), 1000.0);
}

// A hold may stop beyond the end of a move that was to run on into the next.
TEST(Motion, BrakesAcrossAMoveAndDoesNotGoBackForIt) {
  Motion motion(0);
  motion.add(move(400, 1000), 4000, 0, 0);
  motion.add(move(1000, 1000), 4000, 0, 0);
  motion.brake(kSecondNs / 2);
  EXPECT_NEAR(motion.position_at(kSecondNs), 500.0, 1e-6);
  motion.resume(kSecondNs);
  EXPECT_EQ(motion.moves().size(), 1U);
  EXPECT_GE(motion.speed_at(kSecondNs + 1000), 0.0);
  EXPECT_EQ(motion.position_at(3 * kSecondNs), 1000.0);
}

TEST(Motion, WhatWasStaysWhenTheFutureChanges) {
  Motion motion(0);
  motion.add(move(1000, 1000), 4000, 0, 0);
  const double then = motion.position_at(kSecondNs / 3);
  motion.halt(kSecondNs / 2);
  EXPECT_EQ(motion.position_at(kSecondNs / 3), then);
  EXPECT_EQ(motion.position_at(kSecondNs), 375.0);
}

TEST(Motion, LosesEachNthStepBothWays) {
  Motion motion(0, {50, 0});
  motion.add(move(16000, 4000), 40000, 0, 0);
  EXPECT_EQ(motion.motor_steps_at(10 * kSecondNs), 15680.0);
  motion.add(move(0, 4000), 40000, 10 * kSecondNs, 0);
  EXPECT_EQ(motion.motor_steps_at(20 * kSecondNs), 0.0);
  Motion later(0, {50, 5 * kSecondNs});
  later.add(move(16000, 4000), 40000, 0, 0);
  EXPECT_EQ(later.motor_steps_at(4 * kSecondNs), std::round(later.position_at(4 * kSecondNs)));
}

struct Axis {
  GrblSettings settings;
  MotorAxis axis;
  explicit Axis(const MotorOptions& options) : axis(options, 1, 0) {}

  // The instant at which the shaft takes its next step after `from_ns`.
  std::int64_t next_step(std::int64_t from_ns) const {
    const double angle = axis.shaft_angle_deg(from_ns);
    std::int64_t low = from_ns;
    std::int64_t high = from_ns + kSecondNs / 100;
    while (high - low > 1) {
      const std::int64_t middle = (low + high) / 2;
      (axis.shaft_angle_deg(middle) == angle ? low : high) = middle;
    }
    return high;
  }
};

double measured_speed(const Axis& turning) {
  const std::int64_t first = turning.next_step(2 * kSecondNs);
  const std::int64_t last = turning.next_step(7 * kSecondNs);
  const double way = turning.axis.shaft_angle_deg(last) - turning.axis.shaft_angle_deg(first);
  return way / (static_cast<double>(last - first) * 1e-9);
}

// $100 holds 88.889 where the gear has 88.8889: speeds are 1.25e-6 too high.
TEST(MotorAxis, TurnsAtTheSpeedAskedFor) {
  Axis turning{MotorOptions{}};
  turning.settings.set(100, 32000.0 / 360.0);
  turning.axis.move_to(180.0, 22.5, turning.settings, 0);
  EXPECT_NEAR(measured_speed(turning) / 22.5, 1.0, 1e-6);
  EXPECT_NEAR(turning.axis.shaft_angle_deg(20 * kSecondNs), -60.0 + 180.0, 1e-9);
}

TEST(MotorAxis, CrystalGainChangesTheSpeedButNotTheWay) {
  MotorOptions options;
  options.crystal_ppm = 2000.0;
  Axis turning{options};
  turning.axis.move_to(180.0, 22.5, turning.settings, 0);
  EXPECT_NEAR(measured_speed(turning) / 22.5, 1.002, 2e-6);
  EXPECT_NEAR(turning.axis.shaft_angle_deg(20 * kSecondNs), 120.0, 1e-9);
  EXPECT_NEAR(turning.axis.believed_speed_deg_s(turning.settings, 4 * kSecondNs), 22.5, 1e-6);
}

TEST(MotorAxis, StartsLateByARandomTimeWithinBounds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const GrblSettings settings;
    MotorAxis axis(MotorOptions{}, seed, 0);
    axis.move_to(10.0, 100.0, settings, 0);
    EXPECT_EQ(axis.shaft_angle_deg(5'000'000), -60.0);
    EXPECT_GT(axis.shaft_angle_deg(60'000'000), -60.0);
  }
}

TEST(MotorAxis, IsFasterThanItSaysBelowTheFirmwaresFloor) {
  Axis turning{MotorOptions{}};
  turning.settings.set(100, 8.9);  // 30 steps/s are 3.37 deg/s, of a shaft of 88.9 steps/deg
  turning.axis.move_to(100.0, 1.0, turning.settings, 0);
  EXPECT_NEAR(measured_speed(turning), 30.0 * 360.0 / 32000.0, 1e-3);
  EXPECT_NEAR(turning.axis.believed_speed_deg_s(turning.settings, 5 * kSecondNs), 1.0, 1e-9);
}

TEST(MotorAxis, HomesOnTheSwitchWithItsErrorThoughStepsWereLost) {
  MotorOptions options;
  options.lose_every = 10;
  double sum = 0.0;
  double squares = 0.0;
  Axis homing{options};
  constexpr int kHomings = 200;
  std::int64_t now_ns = 0;
  for (int i = 0; i < kHomings; ++i) {
    homing.axis.begin_homing(homing.settings, now_ns);
    now_ns += 4 * kSecondNs;
    homing.axis.finish_homing(homing.settings, now_ns);
    const double error = homing.axis.shaft_angle_deg(now_ns) + 75.0;
    sum += error;
    squares += error * error;
    homing.axis.move_to(-200.0, 180.0, homing.settings, now_ns);
    now_ns += 2 * kSecondNs;
  }
  EXPECT_NEAR(sum / kHomings, 0.0, 0.1);
  EXPECT_NEAR(std::sqrt(squares / kHomings), 0.35, 0.06);
}

TEST(Shaft, RippleRepeatsWithItsPeriod) {
  ShaftOptions options;
  options.ripple_deg = 0.1;
  options.power_up_angle_deg = 0.0;
  EXPECT_NEAR(shaft_angle_deg(options, 16), 0.18 + 0.1, 1e-9);
  EXPECT_NEAR(shaft_angle_deg(options, 64), 0.72, 1e-9);
}

}  // namespace
}  // namespace swivel::sim
