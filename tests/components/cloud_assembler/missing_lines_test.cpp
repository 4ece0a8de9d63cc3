// Lines, angles and windows that do not come, or come late.
#include <gtest/gtest.h>

#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

using testing::Test;

void expect_incomplete(const Stage& stage, std::uint32_t missing, const std::string& word) {
  ASSERT_EQ(stage.sweeps.size(), 1U);
  const msg::Sweep& sweep = stage.sweeps[0].sweep;
  EXPECT_FALSE(sweep.complete());
  EXPECT_EQ(sweep.lines_missing(), missing);
  EXPECT_EQ(sweep.lines_used() + sweep.lines_missing(), sweep.lines_expected());
  EXPECT_NE(sweep.reason().find(word), std::string::npos) << sweep.reason();
  EXPECT_EQ(stage.assembler.counters().sweeps_incomplete, 1U);
  EXPECT_EQ(stage.assembler.counters().sweeps_complete, 0U);
  EXPECT_EQ(stage.assembler.counters().lines_missing, missing);
  stage.expect_counters_add_up();
}

class MissingLines : public Test {
 protected:
  void SetUp() override {
    stage_.add(story_.axis());
    stage_.add(story_.cruising());
  }

  Story story_;
  Stage stage_;
};

TEST_F(MissingLines, AGapIsARowOfItsOwnWhereverItIs) {
  for (int lost = 1; lost < 11; ++lost) {
    Stage stage;
    stage.add(story_.axis());
    stage.add(story_.cruising());
    stage.add_lines(story_, -1, 12, lost);
    expect_incomplete(stage, 1, "1 of 12 lines missing");
    expect_same(stage.sweeps[0].cloud, expected_cloud(story_, {lost}));
  }
}

TEST_F(MissingLines, SeveralGapsAreCounted) {
  for (const int index : {0, 1, 4, 5, 7, 11}) stage_.add(story_.line(index));
  expect_incomplete(stage_, 6, "6 of 12 lines missing");
  expect_same(stage_.sweeps[0].cloud, expected_cloud(story_, {2, 3, 6, 8, 9, 10}));
}

// A sweep begins with the first line that came: then the last row has none.
TEST_F(MissingLines, WithoutItsFirstLineASweepIsNotWhole) {
  stage_.add_lines(story_, -1, 14, 0);
  expect_incomplete(stage_, 1, "1 of 12 lines missing");
  EXPECT_TRUE(stage_.sweeps[0].cloud.line_missing(11));
  EXPECT_EQ(stage_.sweeps[0].sweep.first_beam_time_ns(), story_.line_time_ns(1));
}

TEST_F(MissingLines, TheLastIsGivenUpWhenALineBeyondTheWindowComes) {
  stage_.add_lines(story_, 0, 11);
  EXPECT_TRUE(stage_.sweeps.empty());
  stage_.add(story_.line(13));
  expect_incomplete(stage_, 1, "1 of 12 lines missing");
  expect_same(stage_.sweeps[0].cloud, expected_cloud(story_, {11}));
}

TEST_F(MissingLines, TheLineThatEndsASweepMayBeginTheNext) {
  Story next;
  next.sweep_id = 8;
  next.first_beam_ns = story_.line_time_ns(12);
  stage_.add_lines(story_, 0, 11);
  stage_.add(next.line(0));
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  msg::Axis axis = next.axis();
  axis.samples({next.axis().samples().back()});
  axis.samples()[0].angle_deg(story_.axis().samples()[1].angle_deg() + 13.0);
  stage_.add(axis);
  stage_.add(next.cruising());
  stage_.add_lines(next, 1, 12);
  ASSERT_EQ(stage_.sweeps.size(), 2U);
  EXPECT_TRUE(stage_.sweeps[1].sweep.complete()) << stage_.sweeps[1].sweep.reason();
}

TEST_F(MissingLines, TheLastIsGivenUpASecondAfterTheSequencerLeftTheWindow) {
  stage_.add_lines(story_, 0, 11);
  stage_.add(story_.phase(msg::PHASE_DECELERATING));
  stage_.check_after_s(0.9);
  EXPECT_TRUE(stage_.sweeps.empty());
  stage_.check_after_s(0.2);
  expect_incomplete(stage_, 1, "is the lidar connected");
  expect_same(stage_.sweeps[0].cloud, expected_cloud(story_, {11}));
}

TEST_F(MissingLines, ALineThatComesAfterThatIsCountedAsLate) {
  stage_.add_lines(story_, 0, 11);
  stage_.add(story_.phase(msg::PHASE_DECELERATING));
  stage_.check_after_s(1.1);
  stage_.add(story_.line(11));
  EXPECT_EQ(stage_.assembler.counters().lines_late, 1U);
  EXPECT_EQ(stage_.sweeps.size(), 1U);
  stage_.expect_counters_add_up();
}

TEST_F(MissingLines, ALateLineWithinTheSecondCompletesTheSweep) {
  stage_.add_lines(story_, 0, 11);
  stage_.add(story_.phase(msg::PHASE_DECELERATING));
  stage_.check_after_s(0.9);
  stage_.add(story_.line(11));
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_TRUE(stage_.sweeps[0].sweep.complete());
}

TEST_F(MissingLines, ASilentLidarClosesTheSweep) {
  stage_.add_lines(story_, 0, 3);
  stage_.check_after_s(4.9);
  EXPECT_TRUE(stage_.sweeps.empty());
  stage_.check_after_s(0.2);
  expect_incomplete(stage_, 9, "5 s");
}

TEST_F(MissingLines, ASweepWithoutAnyLineHasNoCloud) {
  stage_.check_after_s(5.1);
  expect_incomplete(stage_, 12, "12 of 12 lines missing");
  EXPECT_TRUE(stage_.sweeps[0].cloud.points.empty());
}

// stop_and_go, its sequencer gone, while the lidar streams on.
TEST(MissingWindows, CloseTheSweepAlthoughLinesKeepComing) {
  const Story story;
  msg::Sweep window = story.cruising();
  window.window_lines(1);
  window.window_end_ns(story.line_time_ns(1));
  Stage stage;
  stage.add(story.axis());
  stage.add(window);
  for (int index = 0; index < 12; ++index) {
    stage.add(story.line(index));
    stage.check_after_s(0.5);
  }
  expect_incomplete(stage, 11, "the sequencer said nothing");
}

TEST(MissingAngles, AxisThatComesLateIsWaitedFor) {
  const Story story;
  Stage stage;
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  EXPECT_TRUE(stage.sweeps.empty());
  stage.add(story.axis());
  ASSERT_EQ(stage.sweeps.size(), 1U);
  EXPECT_TRUE(stage.sweeps[0].sweep.complete());
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
}

TEST(MissingAngles, AreNamedAsTheReason) {
  const Story story;
  Stage stage;
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  stage.add(story.phase(msg::PHASE_DECELERATING));
  stage.check_after_s(1.1);
  expect_incomplete(stage, 12, "axis angles did not come");
}

// An encoder's angles do not belong to a rig whose axis is commanded, nor the other way round.
TEST(MissingAngles, AnAxisOfTheOtherKindIsNotTaken) {
  const Story story;
  msg::Axis measured = story.axis();
  measured.source(msg::AXIS_MEASURED);
  Stage stage;
  stage.add(measured);
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  EXPECT_TRUE(stage.sweeps.empty());
  EXPECT_EQ(stage.assembler.counters().axis_samples_rejected, 2U);
}

TEST(MissingAngles, TheTrackDoesNotRunStraightOverALostMessage) {
  const Story lost;
  Story before = lost, after = lost;
  before.first_beam_ns -= 3'000 * kMillisecondNs;
  after.first_beam_ns += 3'000 * kMillisecondNs;
  msg::Axis axis_before = before.axis(), axis_after = after.axis();
  axis_before.sequence_number(4);
  axis_after.sequence_number(6);
  Stage stage;
  stage.add(axis_before);
  stage.add(lost.cruising());
  stage.add_lines(lost, 0, 12);
  stage.add(axis_after);
  EXPECT_TRUE(stage.sweeps.empty());
  stage.assembler.finish();
  expect_incomplete(stage, 12, "lines missing");
}

// Each line at its own standing position, one of them missed.
TEST(StopAndGo, AMissedWindowIsAMissingRow) {
  Story story;
  story.true_period_ns = 400 * kMillisecondNs;  // from one standing position to the next
  Stage stage;
  stage.add(story.axis());
  for (int index = 0; index < 12; ++index) {
    msg::Sweep window = story.cruising();
    window.window_start_ns(story.line_time_ns(index) - 10 * kMillisecondNs);
    window.window_end_ns(story.line_time_ns(index) + 30 * kMillisecondNs);
    window.window_first_line(static_cast<std::uint32_t>(index));
    window.window_lines(1);
    stage.add(window);
    if (index != 8) stage.add(story.line(index));
  }
  expect_incomplete(stage, 1, "1 of 12 lines missing");
  expect_same(stage.sweeps[0].cloud, expected_cloud(story, {8}));
}

// A killed assembler's successor was told of all sweeps that had been, and called them incomplete.
TEST(LateStart, SweepsWhoseLinesAreGoneAreNotCalledIncomplete) {
  for (const bool lines_come_first : {false, true}) {
    Stage stage;
    stage.check_after_s(0.0);
    Story story;
    Story present;
    present.first_beam_ns += 60'000 * kMillisecondNs;
    if (lines_come_first) stage.add_lines(present, -3, -2);
    for (story.sweep_id = 3; story.sweep_id < 6; ++story.sweep_id) {
      stage.add(story.axis());
      stage.add(story.cruising());
      stage.add(story.phase(msg::PHASE_DECELERATING));
      story.first_beam_ns += 4'000 * kMillisecondNs;
    }
    present.sweep_id = 9;
    if (!lines_come_first) stage.add_lines(present, -3, -2);
    stage.add(present.axis());
    stage.add(present.cruising());
    stage.add_lines(present, -1, 12);
    ASSERT_EQ(stage.sweeps.size(), 1U);
    EXPECT_TRUE(stage.sweeps[0].sweep.complete());
    EXPECT_EQ(stage.assembler.counters().sweeps_before_start, 3U);
    stage.expect_counters_add_up();
  }
}

TEST(LateStart, ASweepLaterOnWithoutLinesIsIncomplete) {
  Stage stage;
  stage.check_after_s(0.0);
  stage.check_after_s(3.0);
  const Story story;
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, 20, 21);
  expect_incomplete(stage, 12, "12 of 12 lines missing");
}

TEST_F(MissingLines, TheNextSweepClosesTheOneBefore) {
  Story next;
  next.sweep_id = 8;
  next.first_beam_ns += 4'000 * kMillisecondNs;
  stage_.add_lines(story_, 0, 6);
  stage_.add(next.axis());
  stage_.add(next.cruising());
  expect_incomplete(stage_, 6, "next sweep began");
  stage_.add_lines(next, 0, 12);
  ASSERT_EQ(stage_.sweeps.size(), 2U);
  EXPECT_TRUE(stage_.sweeps[1].sweep.complete());
  expect_same(stage_.sweeps[1].cloud, expected_cloud(next));
}

}  // namespace
}  // namespace swivel
