// Whatever ends the sequencer, or those who listen to it: the true shaft stops. In mode 7, whose
// turn would last for another 16 s.
#include <gmock/gmock.h>
#include <signal.h>

#include "hardware/io/clock.hpp"
#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class MotorSafety : public ::testing::Test {
 protected:
  MotorSafety() : rig_({"stepper_sequencer"}) {}

  void SetUp() override {
    ASSERT_TRUE(rig_.ready());
    rig_.mark();
    rig_.ask(7);
    ASSERT_TRUE(rig_.await(msg::PHASE_CRUISING));
  }

  void expect_the_shaft_to_stop_within_1_s(std::int64_t since_ns) {
    EXPECT_LT(time_of_standstill_ns(rig_) - since_ns, kSecond_ns);
    EXPECT_LT(rig_.shaft().angle_deg, 60.0);  // far from the end of its turn
  }

  FaultRig rig_;
};

TEST_F(MotorSafety, WhenTheSequencerIsKilled) {
  const std::int64_t killed_ns = now_ns();
  rig_.signal("stepper_sequencer", SIGKILL);
  expect_the_shaft_to_stop_within_1_s(killed_ns);
  // The next one finds the port free, and homes.
  rig_.start("stepper_sequencer");
  EXPECT_TRUE(rig_.ready());
}

TEST_F(MotorSafety, WhenTheSequencerIsToldToStop) {
  const std::int64_t told_ns = now_ns();
  rig_.signal("stepper_sequencer", SIGTERM);
  expect_the_shaft_to_stop_within_1_s(told_ns);
}

TEST_F(MotorSafety, WhenTheControllerFallsSilent) {
  const std::int64_t silent_ns = now_ns();
  rig_.bench("stepper silent 5");
  expect_the_shaft_to_stop_within_1_s(silent_ns);
}

TEST_F(MotorSafety, WhenNobodyListensAnyMore) {
  const std::int64_t left_ns = now_ns();
  rig_.leave();
  expect_the_shaft_to_stop_within_1_s(left_ns);
}

}  // namespace
}  // namespace swivel::test
