// Sweeps that end before they are over: cancelled, at fault; and sweeps that are told twice.
#include <gtest/gtest.h>

#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

class EarlyEnd : public testing::Test {
 protected:
  void SetUp() override {
    stage_.add(story_.axis());
    stage_.add(story_.cruising());
  }

  void expect_taken_back(std::size_t index, const std::string& word) {
    ASSERT_EQ(stage_.sweeps.size(), index + 1);
    const AssembledSweep& sweep = stage_.sweeps[index];
    EXPECT_FALSE(sweep.sweep.complete());
    EXPECT_EQ(sweep.sweep.phase(), msg::PHASE_ASSEMBLED);
    EXPECT_EQ(sweep.sweep.sweep_id(), story_.sweep_id);
    EXPECT_EQ(sweep.sweep.lines_used(), 0U);
    EXPECT_EQ(sweep.sweep.lines_missing(), 12U);
    EXPECT_NE(sweep.sweep.reason().find(word), std::string::npos) << sweep.sweep.reason();
    EXPECT_TRUE(sweep.cloud.points.empty());
    stage_.expect_counters_add_up();
  }

  msg::Sweep cancelled(int at_line) {
    msg::Sweep sweep = story_.phase(msg::PHASE_DECELERATING, "cancelled");
    sweep.time_ns(story_.line_time_ns(at_line));
    return sweep;
  }

  Story story_;
  Stage stage_;
};

TEST_F(EarlyEnd, ACancelledSweepIsAbandoned) {
  stage_.add_lines(story_, 0, 7);
  stage_.add(cancelled(7));
  expect_taken_back(0, "cancelled");
  stage_.add_lines(story_, 7, 20);  // the lidar streams on, the motor no longer turns
  stage_.add(story_.phase(msg::PHASE_IDLE, "cancelled"));
  EXPECT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_EQ(stage_.assembler.counters().sweeps_complete, 0U);
}

TEST_F(EarlyEnd, ACancelThatOvertookEveryLineStillCounts) {
  stage_.add(cancelled(7));
  stage_.add_lines(story_, 0, 20);
  expect_taken_back(0, "cancelled");
}

TEST_F(EarlyEnd, ACancelThatTheLinesOvertookTakesTheSweepBack) {
  stage_.add_lines(story_, 0, 12);
  ASSERT_TRUE(stage_.sweeps.at(0).sweep.complete());
  stage_.add(cancelled(7));
  expect_taken_back(1, "cancelled");
}

TEST_F(EarlyEnd, ACancelAfterTheLastLineLeavesTheSweepWhole) {
  stage_.add_lines(story_, 0, 12);
  stage_.add(cancelled(12));
  EXPECT_EQ(stage_.sweeps.size(), 1U);
}

TEST_F(EarlyEnd, ACancelOnTheWayBackWaitsForTheLastLines) {
  stage_.add_lines(story_, 0, 11);
  stage_.add(story_.phase(msg::PHASE_DECELERATING));
  stage_.add(story_.phase(msg::PHASE_RETURNING));
  stage_.add(story_.phase(msg::PHASE_DECELERATING, "cancelled"));
  stage_.add(story_.line(11));
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_TRUE(stage_.sweeps[0].sweep.complete());
}

// The sequencer told the cancelled turn to its planned end; the next begins before that.
TEST_F(EarlyEnd, TheSweepAfterACancelledOneIsWholeAndAtItsOwnAngles) {
  stage_.add_lines(story_, 0, 3);
  stage_.add(cancelled(3));
  Story next;
  next.sweep_id = 8;
  next.first_beam_ns = story_.line_time_ns(6);
  next.speed_deg_s = 17.0;
  for (int index = 3; index < 6; ++index) stage_.add(story_.line(index));
  for (int index = 0; index < 2; ++index) stage_.add(next.line(index));  // before their window
  stage_.add(next.axis());
  stage_.add(next.cruising());
  stage_.add_lines(next, 2, 12);
  ASSERT_EQ(stage_.sweeps.size(), 2U);
  EXPECT_TRUE(stage_.sweeps[1].sweep.complete()) << stage_.sweeps[1].sweep.reason();
  expect_same(stage_.sweeps[1].cloud, expected_cloud(next));
}

TEST_F(EarlyEnd, AFaultInTheSweepTakesItsCloudAway) {
  stage_.add_lines(story_, 0, 7);
  stage_.add(story_.phase(msg::PHASE_FAULT, "ALARM:1"));
  expect_taken_back(0, "ALARM:1");
  stage_.add(story_.phase(msg::PHASE_FAULT, "ALARM:1; does not answer"));
  stage_.add_lines(story_, 7, 12);
  EXPECT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_EQ(stage_.assembler.counters().lines_late, 5U);
}

TEST_F(EarlyEnd, AFaultRightAfterCompletionTakesTheSweepBackOnce) {
  stage_.add_lines(story_, 0, 12);
  ASSERT_TRUE(stage_.sweeps.at(0).sweep.complete());
  stage_.add(story_.phase(msg::PHASE_FAULT, "ALARM:1"));
  expect_taken_back(1, "ALARM:1");
  EXPECT_EQ(stage_.sweeps[1].sweep.first_beam_time_ns(), story_.first_beam_ns);
  stage_.add(story_.phase(msg::PHASE_FAULT, "ALARM:1; does not answer"));
  EXPECT_EQ(stage_.sweeps.size(), 2U);
}

TEST_F(EarlyEnd, AFaultOfAnotherSweepDoesNotConcernThisOne) {
  msg::Sweep fault = story_.phase(msg::PHASE_FAULT, "ALARM:1");
  fault.sweep_id(6);
  stage_.add_lines(story_, 0, 7);
  stage_.add(fault);
  stage_.add_lines(story_, 7, 12);
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_TRUE(stage_.sweeps[0].sweep.complete());
}

TEST_F(EarlyEnd, ASweepToldTwiceIsAssembledOnce) {
  stage_.add_lines(story_, 0, 5);
  stage_.add(story_.cruising());
  stage_.add_lines(story_, 5, 12);
  stage_.add(story_.phase(msg::PHASE_DECELERATING));
  stage_.add(story_.cruising());
  stage_.check_after_s(20.0);
  stage_.assembler.finish();
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_TRUE(stage_.sweeps[0].sweep.complete());
}

TEST_F(EarlyEnd, AFaultySweepToldTwiceStaysFaulty) {
  stage_.add_lines(story_, 0, 5);
  stage_.add(story_.phase(msg::PHASE_FAULT, "ALARM:1"));
  stage_.add(story_.cruising());
  stage_.add_lines(story_, 5, 12);
  stage_.assembler.finish();
  EXPECT_EQ(stage_.sweeps.size(), 1U);
}

// A recording played again under the same sweep ids, at later times.
TEST_F(EarlyEnd, TheSameIdAtAnotherTimeIsAnotherSweep) {
  stage_.add_lines(story_, 0, 5);
  Story again;
  again.first_beam_ns += 9'000 * kMillisecondNs;
  stage_.add(again.axis());
  stage_.add(again.cruising());
  stage_.add_lines(again, 0, 12);
  ASSERT_EQ(stage_.sweeps.size(), 2U);
  EXPECT_FALSE(stage_.sweeps[0].sweep.complete());
  EXPECT_TRUE(stage_.sweeps[1].sweep.complete());
}

}  // namespace
}  // namespace swivel
