#include "hardware/stepper/stepper_settings.hpp"

#include <gmock/gmock.h>

namespace swivel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::map<int, double> good_values() {
  return {{1, 255},   {13, 0},      {20, 1},      {22, 1},   {27, 5},
          {100, 8.9}, {110, 12000}, {120, 600.0}, {130, 360}};
}

StepperSettings good_settings() {
  return *read_stepper_settings(good_values());
}

const TurnLimits kLimits{-75.0, 330.0, 30.0};
constexpr double kHomeMachineDeg = -355.0;

Outcome check(double angle_deg, double speed_deg_s) {
  return check_turn(kLimits, good_settings(), kHomeMachineDeg, angle_deg, speed_deg_s);
}

TEST(StepperSettings, AreReadInDegreesAndSeconds) {
  const Result<StepperSettings> settings = read_stepper_settings(good_values());
  ASSERT_TRUE(settings) << settings.reason();
  EXPECT_DOUBLE_EQ(settings->steps_per_deg, 8.9);
  EXPECT_DOUBLE_EQ(settings->max_speed_deg_s, 200.0);
  EXPECT_DOUBLE_EQ(settings->acceleration_deg_s2, 600.0);
  EXPECT_DOUBLE_EQ(settings->travel_deg, 360.0);
  EXPECT_DOUBLE_EQ(settings->pull_off_deg, 5.0);
  EXPECT_THAT(settings->advice, IsEmpty());
}

TEST(StepperSettings, AMissingOrSenselessOneIsNamed) {
  for (const int number : {13, 22, 27, 100, 110, 120, 130}) {
    for (const double bad : {-1.0, 1e12}) {
      std::map<int, double> values = good_values();
      values[number] = bad;
      const Result<StepperSettings> settings = read_stepper_settings(values);
      ASSERT_FALSE(settings) << number;
      EXPECT_THAT(settings.reason(), HasSubstr("$" + std::to_string(number) + "="));
    }
    std::map<int, double> values = good_values();
    values.erase(number);
    EXPECT_THAT(read_stepper_settings(values).reason(), HasSubstr("$" + std::to_string(number)));
  }
}

TEST(StepperSettings, HomingOffIsRefusedAndSoftLimitsOffAreAdvisedAgainst) {
  std::map<int, double> values = good_values();
  values[20] = 0;
  values[1] = 25;
  EXPECT_THAT(read_stepper_settings(values)->advice, SizeIs(2));
  values[22] = 0;
  EXPECT_THAT(read_stepper_settings(values).reason(), HasSubstr("homing on"));
}

TEST(LimitsAdvice, IsGivenWhereTheControllerAllowsMoreThanTheRig) {
  TurnLimits limits = kLimits;
  limits.cable_limit_deg = 355.0;  // $130 less the pull-off
  limits.max_speed_deg_s = 200.0;
  EXPECT_THAT(advice_on_limits(limits, good_settings()), IsEmpty());
  limits.cable_limit_deg = 350.0;
  limits.max_speed_deg_s = 190.0;
  EXPECT_THAT(advice_on_limits(limits, good_settings()),
              ElementsAre(HasSubstr("$130=355"), HasSubstr("$110=11400")));
}

TEST(CheckTurn, TheRigsOwnSpeedLimitHoldsToo) {
  TurnLimits limits = kLimits;
  limits.max_speed_deg_s = 150.0;
  const auto check_at = [&](double speed_deg_s) {
    return check_turn(limits, good_settings(), kHomeMachineDeg, 0.0, speed_deg_s);
  };
  EXPECT_TRUE(check_at(150.0));
  EXPECT_THAT(check_at(150.1).reason(), HasSubstr("the rig's 150 deg/s"));
}

TEST(CheckTurn, TheSpeedMustLieBetweenTheFloorAndTheControllersMaximum) {
  EXPECT_TRUE(check(0, 30.0 / 8.9 + 1e-9));
  EXPECT_FALSE(check(0, 30.0 / 8.9 - 1e-3));
  EXPECT_THAT(check(0, 1.0).reason(), HasSubstr("8.9 steps/s"));
  EXPECT_THAT(check(0, 1.0).reason(), HasSubstr("3.37079 deg/s or more"));
  EXPECT_TRUE(check(0, 200.0));
  EXPECT_THAT(check(0, 201.0).reason(), HasSubstr("$110=12000"));
  for (const double senseless : {0.0, -5.0, std::nan("")}) EXPECT_FALSE(check(0, senseless));
}

TEST(CheckTurn, TheCableAllowsTheTurnFromTheHomeSwitchOnly) {
  EXPECT_TRUE(check(-75.0, 90));
  EXPECT_TRUE(check(255.0, 90));
  EXPECT_THAT(check(255.1, 90).reason(), HasSubstr("0 to 330 deg"));
  EXPECT_THAT(check(-76.0, 90).reason(), HasSubstr("-1 deg from the home switch"));
  EXPECT_FALSE(check(std::nan(""), 90));
}

TEST(CheckTurn, TheControllersTravelHoldsToo) {
  const TurnLimits long_cable{-75.0, 1000.0, 30.0};
  const StepperSettings settings = good_settings();
  EXPECT_TRUE(check_turn(long_cable, settings, kHomeMachineDeg, 280.0, 90));
  EXPECT_THAT(check_turn(long_cable, settings, kHomeMachineDeg, 281.0, 90).reason(),
              HasSubstr("$130"));
  EXPECT_THAT(check_turn(long_cable, settings, -27.0, 0.0, 90).reason(), HasSubstr("$23"));
}

TEST(WholeSteps, AreTheNearestOnTheGridFromTheHomeSwitch) {
  const StepperSettings settings = good_settings();
  for (double angle_deg = -75.0; angle_deg < 250.0; angle_deg += 0.173) {
    const double whole_deg = whole_steps_deg(kLimits, settings, angle_deg);
    const double steps = (whole_deg + 75.0) * 8.9;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(whole_deg - angle_deg), 0.5 / 8.9 + 1e-12);
  }
}

}  // namespace
}  // namespace swivel
