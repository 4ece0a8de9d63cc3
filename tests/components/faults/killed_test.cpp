// Participants that are killed in the middle of a sweep, and started again.
#include <gmock/gmock.h>
#include <signal.h>

#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

class Killed : public FaultSuite {
 protected:
  static void kill_in_a_sweep(const std::string& participant) {
    ASSERT_TRUE(rig().go_into_a_sweep());
    rig().signal(participant, SIGKILL);
  }

  // What was under way has come to its end, or to none.
  static void let_the_sweep_end() {
    EXPECT_TRUE(rig().await(msg::PHASE_IDLE));
    EXPECT_TRUE(rig().ready());
    expect_a_right_sweep(rig());
  }
};

TEST_F(Killed, TheReader) {
  kill_in_a_sweep("hokuyo_reader");
  expect_role_back_within_3_s(rig(), "hokuyo_reader");
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(sweep);
  EXPECT_FALSE(sweep->complete());
  let_the_sweep_end();
}

TEST_F(Killed, TheAssembler) {
  kill_in_a_sweep("cloud_assembler");
  expect_role_back_within_3_s(rig(), "cloud_assembler");
  let_the_sweep_end();
}

TEST_F(Killed, TheCorrector) {
  kill_in_a_sweep("attitude_corrector");
  expect_role_back_within_3_s(rig(), "attitude_corrector");
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(rig().await_attitude(sweep->sweep_id()));
  let_the_sweep_end();
}

// The lines of its sweep may all have come: the assembler closes it as incomplete all the same,
// since the shaft was stopped.
TEST_F(Killed, TheSequencer) {
  kill_in_a_sweep("stepper_sequencer");
  expect_role_back_within_3_s(rig(), "stepper_sequencer");
  expect_a_right_sweep(rig());
}

// One that stands still, and so takes no sample, holds nobody up.
TEST_F(Killed, NotButStoppedACorrectorHoldsNobodyUp) {
  rig().signal("attitude_corrector", SIGSTOP);
  rig().ask();
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(sweep->complete()) << sweep->reason();
  EXPECT_TRUE(rig().await(msg::PHASE_IDLE));
  rig().signal("attitude_corrector", SIGCONT);
  EXPECT_TRUE(rig().await_attitude(sweep->sweep_id()));
}

}  // namespace
}  // namespace swivel::test
