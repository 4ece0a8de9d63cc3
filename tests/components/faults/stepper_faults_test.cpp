// What a stepper and its controller do wrong in the middle of a sweep.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

using ::testing::HasSubstr;

const std::string kSequencer = "stepper_sequencer";

class StepperFaults : public FaultSuite {
 protected:
  // Gives the command in the middle of a sweep; the fault that is told of it.
  static std::optional<msg::Sweep> fault_after(const std::string& command) {
    if (!rig().go_into_a_sweep()) return std::nullopt;
    rig().bench(command);
    return rig().await(msg::PHASE_FAULT, 3.0);
  }

  static void expect_taken_back(const msg::Sweep& fault) {
    const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
    ASSERT_TRUE(sweep);
    EXPECT_EQ(sweep->sweep_id(), fault.sweep_id());
    EXPECT_FALSE(sweep->complete());
    EXPECT_THAT(sweep->reason(), HasSubstr("do not use"));
    EXPECT_EQ(sweep->lines_used(), 0U);
  }

  static double seconds_since_mark(const msg::Sweep& sweep) {
    return static_cast<double>(sweep.time_ns() - rig().marked_ns()) * 1e-9;
  }
};

TEST_F(StepperFaults, Unplugged) {
  const auto fault = fault_after("stepper unplug 1");
  ASSERT_TRUE(fault);
  EXPECT_LT(seconds_since_mark(*fault), 0.5);
  EXPECT_THAT(fault->reason(), HasSubstr("unplugged"));
  expect_taken_back(*fault);
  // The controller has power and turns on, but not beyond its turn.
  EXPECT_LT(rig().shaft().highest_deg, -74.0 + 330.0);
  expect_a_right_sweep(rig());
}

TEST_F(StepperFaults, Alarms) {
  for (const int number : {1, 2, 3, 5, 9}) {
    const std::string name = "ALARM:" + std::to_string(number);
    const auto fault = fault_after("stepper alarm " + std::to_string(number));
    ASSERT_TRUE(fault) << name;
    EXPECT_LT(seconds_since_mark(*fault), 0.5) << name;
    EXPECT_THAT(fault->reason(), HasSubstr(name));
    expect_taken_back(*fault);
    ASSERT_TRUE(rig().await(msg::PHASE_IDLE)) << name;
    ASSERT_TRUE(rig().ready()) << name;
    rig().mark();
  }
  expect_a_right_sweep(rig());
}

// And nothing turns before it has homed again.
TEST_F(StepperFaults, AResetByItsSupply) {
  const auto fault = fault_after("stepper reset");
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->reason(), HasSubstr("was reset"));
  rig().ask();
  const auto refused = rig().await(msg::PHASE_REFUSED, 2.0);
  ASSERT_TRUE(refused);
  EXPECT_THAT(refused->reason(), HasSubstr("not ready"));
  ASSERT_TRUE(rig().await(msg::PHASE_IDLE));
  EXPECT_TRUE(rig().await(msg::PHASE_HOMING, 0.0));
  expect_a_right_sweep(rig());
}

// The controller does not know: only the walls at both ends of the sweep do.
TEST_F(StepperFaults, LostStepsMakeTheSweepNotGood) {
  ASSERT_TRUE(rig().go_into_a_sweep(0.2));  // before the plate is seen
  rig().bench("stepper lose 15");
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(sweep);
  const auto attitude = rig().await_attitude(sweep->sweep_id());
  ASSERT_TRUE(attitude);
  EXPECT_NE(attitude->verdict(), msg::VERDICT_GOOD);
  EXPECT_THAT(attitude->reason(), HasSubstr("steps"));
  ASSERT_TRUE(rig().await(msg::PHASE_IDLE));
  expect_a_right_sweep(rig());
}

TEST_F(StepperFaults, AHomeSwitchThatIsNotFoundOrStuck) {
  rig().bench("stepper switch open");
  rig().bench("stepper reset");
  EXPECT_TRUE(rig().await_error(kSequencer, "ALARM:9", 5.0));
  rig().bench("stepper switch closed");
  EXPECT_TRUE(rig().await_error(kSequencer, "ALARM:8", 5.0));
  rig().bench("stepper switch works");
  EXPECT_TRUE(rig().ready());
}

TEST_F(StepperFaults, AnswersThatComeHalfASecondLate) {
  const auto fault = fault_after("stepper delay 520");
  ASSERT_TRUE(fault);
  EXPECT_LT(seconds_since_mark(*fault), 1.2);
  EXPECT_THAT(fault->reason(), HasSubstr("silent"));
  expect_taken_back(*fault);
  rig().bench("stepper delay 0");
  expect_a_right_sweep(rig());
}

}  // namespace
}  // namespace swivel::test
