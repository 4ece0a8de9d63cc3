#include "components/stepper_sequencer/sweep_plan.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/hardware/stepper/grbl_double.hpp"

namespace swivel {
namespace {

using ::testing::HasSubstr;

const TurnLimits kYuanLimits{-75.0, 330.0, 30.0};

StepperSettings settings_with(double acceleration_deg_s2, double steps_per_deg = 88.889) {
  StepperSettings settings;
  settings.steps_per_deg = steps_per_deg;
  settings.max_speed_deg_s = 200.0;
  settings.acceleration_deg_s2 = acceleration_deg_s2;
  settings.travel_deg = 360.0;
  settings.pull_off_deg = 1.0;
  return settings;
}

// An ideal motor given the plan's turn at time 0.
test::IdealTurn ideal(const SweepPlan& plan, const StepperSettings& settings) {
  test::IdealTurn turn;
  turn.from_deg = plan.start_angle_deg;
  turn.to_deg = plan.end_angle_deg;
  turn.speed_deg_s = plan.speed_deg_s;
  turn.acceleration_deg_s2 = settings.acceleration_deg_s2;
  return turn;
}

SweepPlan plan(int mode, const StepperSettings& settings,
               msg::SweepSequence sequence = msg::SEQUENCE_IMPROVED) {
  const Result<SweepPlan> made = plan_sweep({}, kYuanLimits, settings, mode, sequence);
  EXPECT_TRUE(made) << made.reason();
  return made ? *made : SweepPlan();
}

TEST(SweepPlan, TheModesAreThoseOfTable1) {
  const std::map<int, double> seconds = {{1, 1}, {2, 2}, {3, 4}, {4, 5}, {5, 8}, {6, 10}, {7, 16}};
  for (const auto& [mode, T_s] : seconds)
    EXPECT_NEAR(plan(mode, settings_with(720)).speed_deg_s, 180.0 / T_s, 1e-9) << mode;
}

TEST(SweepPlan, TheWindowLiesInConstantSpeedWithTheSettlingTimeOnBothSides) {
  for (const double acceleration : {300.0, 720.0, 5000.0}) {
    for (int mode = 1; mode <= 7; ++mode) {
      const StepperSettings settings = settings_with(acceleration);
      const SweepPlan made = plan(mode, settings);
      const test::IdealTurn turn = ideal(made, settings);
      const double opens_s = made.window_delay_s;
      const double closes_s = opens_s + made.window_s;
      const double step_s = 1.0 / settings.steps_per_deg / made.speed_deg_s;
      EXPECT_GE(opens_s - static_cast<double>(turn.steady_start_ns()) * 1e-9, 0.15 - 1e-6);
      EXPECT_GE(static_cast<double>(turn.steady_end_ns()) * 1e-9 - closes_s, 0.15 - step_s);
      EXPECT_NEAR(turn.angle_deg(std::llround(opens_s * 1e9)), made.window_angle_deg, 1e-5);
      EXPECT_NEAR(made.window_angle_deg, 0.0, 0.5 / settings.steps_per_deg);
      EXPECT_NEAR(turn.angle_deg(turn.steady_start_ns()), made.steady_start_deg, 1e-5);
      EXPECT_NEAR(turn.angle_deg(turn.steady_end_ns()), made.steady_end_deg, 1e-5);
    }
  }
}

TEST(SweepPlan, TheWindowHoldsItsLinesWhereverTheyFallAndThoughTheLidarBeSlow) {
  constexpr double kSlow_s = 0.025 * 1.005;
  for (int mode = 1; mode <= 7; ++mode) {
    const SweepPlan made = plan(mode, settings_with(720));
    for (double phase = 0.0; phase < 1.0; phase += 0.01) {
      const double first_line_s = std::ceil(-phase + 1e-9) * kSlow_s + phase * kSlow_s;
      EXPECT_LE(first_line_s + made.lines * kSlow_s, made.window_s - kSlow_s + 1e-9);
    }
    const SweepPlan stepwise = plan(mode, settings_with(720), msg::SEQUENCE_STOP_AND_GO);
    EXPECT_GT(stepwise.window_s, 2.0 * kSlow_s);
  }
}

TEST(SweepPlan, YuansRigCanDoAllModes) {
  for (int mode = 1; mode <= 7; ++mode) {
    for (const auto sequence : {msg::SEQUENCE_IMPROVED, msg::SEQUENCE_NAIVE}) {
      const StepperSettings settings = settings_with(720);
      const SweepPlan made = plan(mode, settings, sequence);
      for (const double angle_deg : {made.start_angle_deg, made.end_angle_deg}) {
        const Outcome allowed =
            check_turn(kYuanLimits, settings, -359.0, angle_deg, made.speed_deg_s);
        EXPECT_TRUE(allowed) << mode << ": " << allowed.reason();
      }
    }
  }
}

TEST(SweepPlan, NoTurnThatIsAllowedPassesTheCableOnItsWay) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> home_deg(-120.0, 0.0);
  std::uniform_real_distribution<double> cable_deg(100.0, 400.0);
  std::uniform_real_distribution<double> acceleration(50.0, 5000.0);
  int allowed_count = 0;
  for (int run = 0; run < 3000; ++run) {
    const TurnLimits limits{home_deg(random), cable_deg(random), 30.0};
    const StepperSettings settings = settings_with(acceleration(random));
    const auto made = plan_sweep({}, limits, settings, 1 + run % 7, msg::SEQUENCE_IMPROVED);
    ASSERT_TRUE(made);
    const bool allowed =
        check_turn(limits, settings, -359.0, made->start_angle_deg, made->speed_deg_s) &&
        check_turn(limits, settings, -359.0, made->end_angle_deg, made->speed_deg_s);
    if (!allowed) continue;
    ++allowed_count;
    const test::IdealTurn turn = ideal(*made, settings);
    for (std::int64_t at_ns = 0; at_ns <= turn.end_ns(); at_ns += 50'000'000) {
      const double from_home_deg = turn.angle_deg(at_ns) - limits.home_angle_deg;
      ASSERT_TRUE(from_home_deg >= -0.02 && from_home_deg <= limits.cable_limit_deg);
    }
  }
  EXPECT_GT(allowed_count, 300);
}

TEST(SweepPlan, NaivePretendsThatTheMotorHasNoMass) {
  const SweepPlan made = plan(1, settings_with(720), msg::SEQUENCE_NAIVE);
  EXPECT_EQ(made.window_delay_s, 0.0);
  EXPECT_NEAR(made.start_angle_deg, 0.0, 0.01);
  EXPECT_NEAR(made.end_angle_deg, 180.0, 0.01);
}

TEST(SweepPlan, StopAndGoStandsOnWholeStepsThatDoNotDrift) {
  for (const double steps_per_deg : {8.9, 88.889}) {
    const SweepPlan made = plan(7, settings_with(720, steps_per_deg), msg::SEQUENCE_STOP_AND_GO);
    ASSERT_EQ(made.line_angles_deg.size(), 640U);
    for (std::size_t line = 0; line < 640; ++line) {
      const double angle_deg = made.line_angles_deg[line];
      EXPECT_NEAR(angle_deg, 0.28125 * static_cast<double>(line), 0.5 / steps_per_deg + 1e-9);
      const double steps = (angle_deg + 75.0) * steps_per_deg;
      EXPECT_NEAR(steps, std::round(steps), 1e-6);
    }
    EXPECT_LT(made.start_angle_deg, made.line_angles_deg.front());
  }
}

TEST(SweepPlan, AnUnknownModeOrSequenceIsRefused) {
  const StepperSettings settings = settings_with(720);
  EXPECT_THAT(plan_sweep({}, kYuanLimits, settings, 8, msg::SEQUENCE_IMPROVED).reason(),
              HasSubstr("this rig has 1 2 3 4 5 6 7"));
  const auto unknown = static_cast<msg::SweepSequence>(9);
  EXPECT_FALSE(plan_sweep({}, kYuanLimits, settings, 1, unknown));
}

}  // namespace
}  // namespace swivel
