// Any writer on the topics may send anything.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(HostileLines, AreRejectedAndCountedAndLeaveAGap) {
  const std::vector<std::function<void(msg::ScanLine&)>> faults{
      [](msg::ScanLine& line) { line.ranges_mm().clear(); },
      [](msg::ScanLine& line) { line.ranges_mm().resize(18); },  // not the intensities
      [](msg::ScanLine& line) { line.ranges_mm().resize(18), line.intensities().resize(18); },
      [](msg::ScanLine& line) { line.ranges_mm().resize(60000), line.intensities().clear(); },
      [](msg::ScanLine& line) { line.first_beam_angle_deg(kNaN); },
      [](msg::ScanLine& line) { line.beam_step_deg(kInfinity); },
      [](msg::ScanLine& line) { line.beam_step_deg(0.25); },
      [](msg::ScanLine& line) { line.beam_period_ns(0.0); },
      [](msg::ScanLine& line) { line.beam_period_ns(-1.0); },
      [](msg::ScanLine& line) { line.beam_period_ns(kNaN); },
      [](msg::ScanLine& line) { line.beam_period_ns(1e9); },
      [](msg::ScanLine& line) { line.scan_period_ns(0.0); },
      [](msg::ScanLine& line) { line.scan_period_ns(kNaN); },
      [](msg::ScanLine& line) { line.scan_period_ns(1e300); },
      [](msg::ScanLine& line) { line.beam0_time_ns(0); },
      [](msg::ScanLine& line) { line.beam0_time_ns(std::numeric_limits<std::int64_t>::min()); },
      [](msg::ScanLine& line) { line.beam0_time_ns(std::numeric_limits<std::int64_t>::max()); },
  };
  const Story story;
  for (std::size_t fault = 0; fault < faults.size(); ++fault) {
    Stage stage;
    stage.add(story.axis());
    stage.add(story.cruising());
    stage.add_lines(story, 0, 5);
    msg::ScanLine line = story.line(5);
    faults[fault](line);
    stage.add(line);
    stage.add_lines(story, 6, 12);
    EXPECT_EQ(stage.assembler.counters().lines_rejected, 1U) << "fault " << fault;
    ASSERT_EQ(stage.sweeps.size(), 1U) << "fault " << fault;
    EXPECT_EQ(stage.sweeps[0].sweep.lines_missing(), 1U) << "fault " << fault;
    expect_same(stage.sweeps[0].cloud, expected_cloud(story, {5}));
    stage.expect_counters_add_up();
  }
}

TEST(HostileLines, OfASingleBeamAndAHairsPeriodDoNoHarm) {
  const Story story;
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  for (int index = 0; index < 12; ++index) {
    msg::ScanLine line = story.line(index);
    line.ranges_mm().resize(1);
    line.intensities().clear();
    line.scan_period_ns(1e-300);
    line.beam_period_ns(1e-301);
    stage.add(line);
  }
  EXPECT_EQ(stage.assembler.counters().lines_rejected, 12U);
}

TEST(HostileLines, ALineToldTwiceTakesNoRow) {
  const Story story;
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  for (int index = 0; index < 12; ++index) {
    stage.add(story.line(index));
    if (index < 11) stage.add(story.line(index));
  }
  ASSERT_EQ(stage.sweeps.size(), 1U);
  EXPECT_TRUE(stage.sweeps[0].sweep.complete());
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
  EXPECT_EQ(stage.assembler.counters().lines_rejected, 11U);
}

TEST(HostileLines, ToldTwiceBeforeTheirWindowTakeNoRowEither) {
  const Story story;
  Stage stage;
  for (int index = 0; index < 12; ++index) {
    stage.add(story.line(index));
    stage.add(story.line(index));
  }
  stage.add(story.axis());
  stage.add(story.cruising());
  ASSERT_EQ(stage.sweeps.size(), 1U);
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
}

TEST(HostileWindows, AreRefusedAndCounted) {
  const std::vector<std::function<void(msg::Sweep&)>> faults{
      [](msg::Sweep& sweep) { sweep.sweep_id(0); },
      [](msg::Sweep& sweep) { sweep.lines_expected(0); },
      [](msg::Sweep& sweep) { sweep.lines_expected(20001), sweep.window_lines(20001); },
      [](msg::Sweep& sweep) { sweep.lines_expected(0xFFFFFFFFU); },
      [](msg::Sweep& sweep) { sweep.window_lines(0); },
      [](msg::Sweep& sweep) { sweep.window_lines(13); },
      [](msg::Sweep& sweep) { sweep.window_lines(0xFFFFFFFFU); },
      [](msg::Sweep& sweep) { sweep.window_first_line(12); },
      [](msg::Sweep& sweep) { sweep.window_first_line(1); },
      [](msg::Sweep& sweep) { sweep.window_first_line(0xFFFFFFFFU); },
      [](msg::Sweep& sweep) { sweep.window_end_ns(sweep.window_start_ns()); },
      [](msg::Sweep& sweep) { sweep.window_end_ns(sweep.window_start_ns() - 1); },
  };
  const Story story;
  for (std::size_t fault = 0; fault < faults.size(); ++fault) {
    msg::Sweep sweep = story.cruising();
    faults[fault](sweep);
    Stage stage;
    stage.add(story.axis());
    stage.add(sweep);
    stage.add_lines(story, 0, 12);
    stage.assembler.finish();
    EXPECT_TRUE(stage.sweeps.empty()) << "fault " << fault;
    EXPECT_EQ(stage.assembler.counters().windows_rejected, 1U) << "fault " << fault;
  }
}

// 20000 lines of 10000 beams would be 3 GB.
TEST(HostileWindows, TooManyPointsInAllAreRefused) {
  Story story;
  story.lines = 20000;
  story.beams = 10000;
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  msg::ScanLine line = story.line(0);
  line.beam_period_ns(10.0);
  stage.add(line);
  stage.assembler.finish();
  EXPECT_EQ(stage.assembler.counters().lines_rejected, 1U);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  EXPECT_FALSE(stage.sweeps[0].sweep.complete());
  EXPECT_TRUE(stage.sweeps[0].cloud.points.empty());
}

class SecondWindow : public testing::Test {
 protected:
  void add_second(const std::function<void(msg::Sweep&)>& fault) {
    msg::Sweep first = story_.cruising();
    first.window_lines(6);
    first.window_end_ns(story_.line_time_ns(6));
    msg::Sweep second = story_.cruising();
    second.window_first_line(6);
    second.window_lines(6);
    second.window_start_ns(story_.line_time_ns(6));
    fault(second);
    stage_.add(story_.axis());
    stage_.add(first);
    stage_.add(second);
    stage_.add_lines(story_, 0, 12);
    stage_.assembler.finish();
  }

  Story story_;
  Stage stage_;
};

TEST_F(SecondWindow, ContinuesTheFirst) {
  add_second([](msg::Sweep&) {});
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_TRUE(stage_.sweeps[0].sweep.complete());
  expect_same(stage_.sweeps[0].cloud, expected_cloud(story_));
}

TEST_F(SecondWindow, MayNotClaimRowsThatTheCloudDoesNotHave) {
  add_second([](msg::Sweep& sweep) {
    sweep.lines_expected(20000);
    sweep.window_first_line(15000);
  });
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_EQ(stage_.sweeps[0].sweep.lines_used(), 6U);
  EXPECT_EQ(stage_.assembler.counters().windows_rejected, 1U);
}

// Else one row filled twice would be counted as two, and a sweep with a hole be whole.
TEST_F(SecondWindow, MayNotClaimTheFirstOnesRows) {
  add_second([](msg::Sweep& sweep) { sweep.window_first_line(3); });
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_FALSE(stage_.sweeps[0].sweep.complete());
  EXPECT_EQ(stage_.assembler.counters().windows_rejected, 1U);
}

TEST_F(SecondWindow, MayNotBeginBeforeTheFirstHasEnded) {
  add_second([this](msg::Sweep& sweep) { sweep.window_start_ns(story_.line_time_ns(2)); });
  ASSERT_EQ(stage_.sweeps.size(), 1U);
  EXPECT_EQ(stage_.sweeps[0].sweep.lines_used(), 6U);
  EXPECT_EQ(stage_.assembler.counters().windows_rejected, 1U);
}

TEST(HostileAxis, AStraySampleFromTheEndOfTimeDoesNotStopTheNextSweep) {
  const Story story;
  msg::Axis stray = story.axis();
  stray.samples()[0].time_ns(std::numeric_limits<std::int64_t>::min());
  stray.samples()[1].time_ns(std::numeric_limits<std::int64_t>::max());
  Stage stage;
  stage.add(stray);
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
}

TEST(HostileAxis, SamplesThatAreNoNumbersOrNotLaterAreCounted) {
  const Story story;
  msg::Axis axis = story.axis();
  axis.samples().insert(axis.samples().begin() + 1, axis.samples()[0]);
  axis.samples()[1].angle_deg(77.0);
  axis.samples().insert(axis.samples().begin() + 2, axis.samples()[3 - 1]);
  axis.samples()[2].time_ns(story.line_time_ns(3));
  axis.samples()[2].angle_deg(kNaN);
  Stage stage;
  stage.add(axis);
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  EXPECT_EQ(stage.assembler.counters().axis_samples_rejected, 2U);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
}

TEST(Assembler, HoldsABoundedNumberOfLines) {
  const Story story;
  Stage stage;
  stage.add_lines(story, 0, 3000);
  EXPECT_EQ(stage.assembler.lines_waiting(), 400U);
  stage.expect_counters_add_up();
}

// Whatever comes: no line is lost without a count, no sweep is whole with a hole.
TEST(Assembler, ARandomStreamKeepsTheBooks) {
  std::mt19937 random(20260101);
  Stage stage;
  Story story;
  const auto pick = [&](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  for (int step = 0; step < 6000; ++step) {
    msg::ScanLine line = story.line(pick(14) - 1);
    switch (pick(14)) {
      case 0:
        story.sweep_id += static_cast<std::uint64_t>(pick(2));
        story.first_beam_ns += pick(400) * kMillisecondNs;
        break;
      case 1:
        stage.add(story.axis());
        break;
      case 2:
        stage.add(story.cruising());
        break;
      case 3:
        stage.add(story.phase(static_cast<msg::SweepPhase>(pick(9)), pick(2) == 0 ? "" : "why"));
        break;
      case 4:
        line.ranges_mm().resize(static_cast<std::size_t>(pick(19)));
        stage.add(line);
        break;
      case 5:
        stage.check_after_s(pick(3));
        break;
      case 6:
        stage.add(story.axis());
        stage.add(story.cruising());
        stage.add_lines(story, 0, 12);
        break;
      default:
        stage.add(line);
    }
    stage.expect_counters_add_up();
  }
  int whole = 0;
  for (const AssembledSweep& sweep : stage.sweeps) {
    EXPECT_EQ(sweep.sweep.complete(), sweep.sweep.lines_missing() == 0);
    for (std::size_t row = 0; sweep.sweep.complete() && row < sweep.cloud.lines; ++row) {
      ASSERT_FALSE(sweep.cloud.line_missing(row));
    }
    whole += sweep.sweep.complete() ? 1 : 0;
  }
  EXPECT_GT(whole, 30);
  EXPECT_GT(stage.sweeps.size() - static_cast<std::size_t>(whole), 30U);
}

}  // namespace
}  // namespace swivel
