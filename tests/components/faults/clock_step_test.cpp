// Somebody, or NTP, sets the computer's time in the middle of a sweep.
#include <gmock/gmock.h>

#include <cstdint>
#include <fstream>

#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

constexpr std::int64_t kHour_ns = 3600LL * 1'000'000'000;

class ClockStep : public ::testing::Test {
 protected:
  ClockStep() {
    step_to(0);
    setenv("SWIVEL_STEPPED_CLOCK", offset_file().c_str(), 1);
    rig_ = std::make_unique<FaultRig>(
        std::vector<std::string>{"stepper_sequencer", "hokuyo_reader", "cloud_assembler",
                                 "attitude_corrector"},
        FaultRigOptions{{}, {}, STEPPED_CLOCK});
  }
  ~ClockStep() override { unsetenv("SWIVEL_STEPPED_CLOCK"); }

  FaultRig& rig() { return *rig_; }
  std::string offset_file() const { return scratch_.file("offset_ns"); }

  // In place: the participants have it mapped.
  void step_to(std::int64_t offset_ns) const {
    std::fstream file(offset_file(), std::ios::in | std::ios::out | std::ios::binary);
    if (!file) file.open(offset_file(), std::ios::out | std::ios::binary);
    file.write(reinterpret_cast<const char*>(&offset_ns), sizeof offset_ns);
  }

  // Once the shaft is well on its way; the participants' clock says nothing to the test.
  bool step_in_a_sweep_to(std::int64_t offset_ns) {
    rig().mark();
    rig().ask();
    if (!rig().await(msg::PHASE_CRUISING)) return false;
    const double start_deg = rig().shaft().angle_deg;
    while (std::abs(rig().shaft().angle_deg - start_deg) < 60.0) usleep(1000);
    step_to(offset_ns);
    return true;
  }

  // Whatever is said of that sweep, what is called good is right; and the next is.
  void expect_nothing_wrong_and_the_next_right() {
    const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
    ASSERT_TRUE(sweep);
    const auto attitude = rig().await_attitude(sweep->sweep_id(), 1.0);
    const bool good = sweep->complete() && attitude && attitude->verdict() == msg::VERDICT_GOOD;
    if (good) {
      expect_true(rig(), *attitude);
    } else {
      EXPECT_NE(sweep->reason(), "");
    }
    expect_a_right_sweep(rig());
  }

 private:
  ScratchFolder scratch_;
  std::unique_ptr<FaultRig> rig_;
};

TEST_F(ClockStep, AnHourForwardAndBackAgain) {
  ASSERT_TRUE(rig().ready());
  ASSERT_TRUE(step_in_a_sweep_to(kHour_ns));
  expect_nothing_wrong_and_the_next_right();
  EXPECT_EQ(rig().counter("hokuyo_reader", "clock_restarts"), 1U);
  ASSERT_TRUE(step_in_a_sweep_to(0));
  expect_nothing_wrong_and_the_next_right();
  EXPECT_EQ(rig().counter("hokuyo_reader", "clock_restarts"), 2U);
}

}  // namespace
}  // namespace swivel::test
