#include "components/stepper_sequencer/sequencer.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/components/stepper_sequencer/sequencer_rig.hpp"

namespace swivel {
namespace {

using test::GrblDoubleOptions;
using test::IdealTurn;
using test::SequencerRig;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<msg::SweepPhase> phases_of(const std::vector<msg::Sweep>& sweeps) {
  std::vector<msg::SweepPhase> phases;
  phases.reserve(sweeps.size());
  for (const msg::Sweep& sweep : sweeps) phases.push_back(sweep.phase());
  return phases;
}

void expect_never_beyond_the_cable(const SequencerRig& rig) {
  for (const IdealTurn& turn : rig.peer.turns()) {
    for (const double machine_deg : {turn.from_deg, turn.to_deg}) {
      EXPECT_GE(rig.axis_deg(machine_deg), -75.0 - 1e-6);
      EXPECT_LE(rig.axis_deg(machine_deg), -75.0 + 330.0);
    }
  }
}

TEST(Sequencer, HomesAtItsStartAndIsIdle) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  EXPECT_THAT(phases_of(rig.sweeps()), ElementsAre(msg::PHASE_HOMING, msg::PHASE_IDLE));
  EXPECT_EQ(rig.peer.homings(), 1);
  EXPECT_TRUE(rig.sequencer.health().ready);
  EXPECT_EQ(rig.sequencer.health().firmware, "1.1h");
  EXPECT_GT(rig.sweeps()[0].time_ns(), 0);
}

TEST(Sequencer, ARequestOfTwoSweepsGoesThroughItsPhases) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  const std::uint64_t request_id = rig.ask(1, 2);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  EXPECT_THAT(phases_of(rig.sweeps()),
              ElementsAre(msg::PHASE_HOMING, msg::PHASE_IDLE, msg::PHASE_RETURNING,
                          msg::PHASE_ACCELERATING, msg::PHASE_CRUISING, msg::PHASE_DECELERATING,
                          msg::PHASE_RETURNING, msg::PHASE_ACCELERATING, msg::PHASE_CRUISING,
                          msg::PHASE_DECELERATING, msg::PHASE_RETURNING, msg::PHASE_IDLE));
  const std::vector<msg::Sweep> cruising = rig.sweeps(msg::PHASE_CRUISING);
  EXPECT_EQ(cruising[0].request_id(), request_id);
  EXPECT_EQ(cruising[0].sweeps_left(), 1);
  EXPECT_EQ(cruising[1].sweeps_left(), 0);
  EXPECT_GT(cruising[0].sweep_id(), 1'500'000'000U);  // seconds since 1970
  EXPECT_GT(cruising[1].sweep_id(), cruising[0].sweep_id());
  EXPECT_EQ(rig.sweeps()[2].sweep_id(), 0U);
  EXPECT_EQ(cruising[0].mode(), 1);
  EXPECT_NEAR(cruising[0].speed_deg_s(), 180.0, 1e-9);
  EXPECT_EQ(cruising[0].lines_expected(), 1U);
  EXPECT_EQ(cruising[0].window_first_line(), 0U);
  EXPECT_EQ(cruising[0].window_lines(), 1U);
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 2U);
}

// Against the truth of the double: the window, and the angles said of it.
void expect_window_in_constant_speed(const SequencerRig& rig, const msg::Sweep& sweep,
                                     const msg::Axis& axis) {
  const IdealTurn turn = rig.turn_at(sweep.window_start_ns());
  EXPECT_GE(sweep.window_start_ns(), turn.steady_start_ns());
  EXPECT_LE(sweep.window_end_ns(), turn.steady_end_ns());
  ASSERT_EQ(axis.samples().size(), 2U);
  EXPECT_EQ(axis.source(), msg::AXIS_COMMANDED);
  EXPECT_EQ(axis.samples()[0].time_ns(), sweep.window_start_ns());
  EXPECT_EQ(axis.samples()[1].time_ns(), sweep.window_end_ns());
  std::vector<double> late_deg;
  for (const msg::AxisSample& sample : axis.samples())
    late_deg.push_back(sample.angle_deg() - rig.axis_deg(turn.angle_deg(sample.time_ns())));
  EXPECT_NEAR(late_deg[1], late_deg[0], 1e-3);  // a shift in time at most: the shape is true
  EXPECT_LT(std::abs(late_deg[0]), 0.15 * sweep.speed_deg_s());
  EXPECT_NEAR(axis.samples()[0].angle_deg(), 0.0, 0.01);
}

TEST(Sequencer, EveryModesWindowLiesInTheTrueConstantSpeed) {
  GrblDoubleOptions late_motor;
  late_motor.turn_delay_s = 0.03;
  SequencerRig rig(late_motor);
  ASSERT_TRUE(rig.ready());
  for (int mode = 1; mode <= 7; ++mode) {
    rig.ask(mode, 1);
    ASSERT_TRUE(rig.await(msg::PHASE_IDLE, static_cast<std::size_t>(1 + mode))) << mode;
    const std::vector<msg::Sweep> cruising = rig.sweeps(msg::PHASE_CRUISING);
    ASSERT_EQ(cruising.size(), static_cast<std::size_t>(mode));
    EXPECT_NEAR(cruising.back().speed_deg_s(), 4.5 / (cruising.back().lines_expected() * 0.025),
                1e-9);
    expect_window_in_constant_speed(rig, cruising.back(), rig.axes().back());
  }
  expect_never_beyond_the_cable(rig);
}

TEST(Sequencer, AnOkThatIsReadLateMovesTheWindowNotTheTurn) {
  GrblDoubleOptions late_ok;
  late_ok.turn_delay_s = -0.45;  // by then a window counted from the ok ends beyond constant speed
  SequencerRig rig(late_ok);
  ASSERT_TRUE(rig.ready());
  rig.ask(1, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING)) << rig.sweeps().back().reason();
  expect_window_in_constant_speed(rig, rig.sweeps(msg::PHASE_CRUISING).back(), rig.axes().back());
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 1U);
}

TEST(Sequencer, AWindowIsAnnouncedBeforeItsLinesAreOver) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(3, 1);
  const std::optional<msg::Sweep> cruising = rig.await(msg::PHASE_CRUISING);
  ASSERT_TRUE(cruising);
  EXPECT_EQ(rig.axes().size(), 1U);  // the angles come first
  EXPECT_LT(cruising->time_ns(), cruising->window_end_ns());
}

TEST(Sequencer, NaiveCountsFromTheJogAndSoItsAnglesAreAheadOfTheShaft) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(1, 1, msg::SEQUENCE_NAIVE);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  const msg::Sweep cruising = rig.sweeps(msg::PHASE_CRUISING).at(0);
  const IdealTurn turn = rig.turn_at(cruising.window_end_ns());
  EXPECT_LE(cruising.window_start_ns(), turn.start_ns);
  EXPECT_GE(cruising.window_start_ns(), turn.start_ns - 200'000'000);
  const std::vector<msg::AxisSample> samples = rig.axes().at(0).samples();
  const double pretended_deg = samples[1].angle_deg() - samples[0].angle_deg();
  EXPECT_NEAR(pretended_deg, 180.0 * (1 + 2) * 0.025 * 1.005, 1e-6);
  EXPECT_GT(samples[1].angle_deg(), rig.axis_deg(turn.angle_deg(samples[1].time_ns())) + 4.0);
  EXPECT_EQ(cruising.action_sequence(), msg::SEQUENCE_NAIVE);
}

TEST(Sequencer, StopAndGoStandsStillInEveryWindow) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(4, 1, msg::SEQUENCE_STOP_AND_GO);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  const std::vector<msg::Sweep> cruising = rig.sweeps(msg::PHASE_CRUISING);
  const std::vector<msg::Axis> axes = rig.axes();
  ASSERT_EQ(cruising.size(), 5U);
  ASSERT_EQ(axes.size(), 5U);
  std::int64_t before_ns = 0;
  for (std::size_t line = 0; line < 5; ++line) {
    const msg::Sweep& sweep = cruising[line];
    EXPECT_EQ(sweep.window_first_line(), line);
    EXPECT_EQ(sweep.window_lines(), 1U);
    EXPECT_EQ(sweep.lines_expected(), 5U);
    EXPECT_GT(sweep.window_start_ns(), before_ns);
    EXPECT_GT(sweep.window_end_ns() - sweep.window_start_ns(), 50'250'000);
    const std::vector<msg::AxisSample>& samples = axes[line].samples();
    EXPECT_EQ(samples[0].angle_deg(), samples[1].angle_deg());
    EXPECT_NEAR(samples[0].angle_deg(), 4.5 / 5 * static_cast<double>(line), 0.005);
    for (const msg::AxisSample& sample : samples) {
      const IdealTurn turn = rig.turn_at(sample.time_ns());
      EXPECT_LE(turn.end_ns(), sample.time_ns());
      EXPECT_NEAR(rig.axis_deg(turn.angle_deg(sample.time_ns())), sample.angle_deg(), 1e-3);
    }
    before_ns = sweep.window_end_ns();
  }
  expect_never_beyond_the_cable(rig);
}

// Within 50 ms: as long as a loaded computer may take for a question and its answer, and half.
void expect_passed_about_then(const SequencerRig& rig, const msg::AxisSample& sample) {
  if (sample.time_ns() < rig.peer.turns().front().start_ns + 50'000'000) return;
  double lowest_deg = 1e9;
  double highest_deg = -1e9;
  for (int part = -10; part <= 10; ++part) {
    const std::int64_t time_ns = sample.time_ns() + part * 5'000'000;
    const double true_deg = rig.axis_deg(rig.turn_at(time_ns).angle_deg(time_ns));
    lowest_deg = std::min(lowest_deg, true_deg);
    highest_deg = std::max(highest_deg, true_deg);
  }
  EXPECT_GT(sample.angle_deg(), lowest_deg - 0.01);
  EXPECT_LT(sample.angle_deg(), highest_deg + 0.01);
}

// Each angle said of a pan unit is one that the shaft passed about then, and every window lies
// between samples.
TEST(Sequencer, AMeasuredAxisIsToldAsTheControllerReportsIt) {
  SequencerRig rig({}, [](SequencerOptions& options) {
    options.sweep.axis_measured = true;
    options.poll_interval_s = 0.02;
  });
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 2);  // 20 positions a window: a busy machine may miss most of them
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  std::vector<msg::AxisSample> samples;
  for (const msg::Axis& axis : rig.axes()) {
    EXPECT_EQ(axis.source(), msg::AXIS_MEASURED);
    for (const msg::AxisSample& sample : axis.samples()) {
      EXPECT_TRUE(samples.empty() || sample.time_ns() > samples.back().time_ns());
      samples.push_back(sample);
      expect_passed_about_then(rig, sample);
    }
  }
  for (const msg::Sweep& window : rig.sweeps(msg::PHASE_CRUISING)) {
    const auto within = std::count_if(samples.begin(), samples.end(), [&](const auto& sample) {
      return sample.time_ns() > window.window_start_ns() &&
             sample.time_ns() < window.window_end_ns();
    });
    EXPECT_GE(within, 3);
    EXPECT_LT(samples.front().time_ns(), window.window_start_ns());
    EXPECT_GT(samples.back().time_ns(), window.window_end_ns());
  }
}

StepperStatus report_of(double speed_deg_s, std::int64_t asked_ns, std::int64_t measured_ns,
                        std::int64_t answered_ns) {
  StepperStatus report;
  report.asked_ns = asked_ns;
  report.answered_ns = answered_ns;
  report.angle_deg = speed_deg_s * 1e-9 * static_cast<double>(measured_ns);
  return report;
}

// The instant of a position is anywhere between question and answer; here answers take 0.5 to
// 20 ms, as on a busy computer.
TEST(MeasuredAxis, TakesTheReportsWhoseInstantIsCertain) {
  constexpr double kSpeed_deg_s = 80.0;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  MeasuredAxis axis;
  double squares = 0.0;
  int taken = 0;
  std::int64_t last_ns = 0;
  std::int64_t now_ns = 1'000'000'000;
  for (int i = 0; i < 2000; ++i, now_ns += 20'000'000) {
    const double hurry = part(random);
    const auto trip_ns = static_cast<std::int64_t>(5e5 + 19.5e6 * hurry * hurry);
    const auto waited_ns = static_cast<std::int64_t>(part(random) * static_cast<double>(trip_ns));
    const auto sample =
        axis.add(report_of(kSpeed_deg_s, now_ns, now_ns + waited_ns, now_ns + trip_ns));
    if (!sample) continue;
    const double error_deg =
        sample->angle_deg() - kSpeed_deg_s * 1e-9 * static_cast<double>(sample->time_ns());
    EXPECT_LE(std::abs(error_deg), kSpeed_deg_s * 0.5e-9 * static_cast<double>(trip_ns) + 1e-6);
    EXPECT_TRUE(last_ns == 0 || sample->time_ns() - last_ns <= 230'000'000);
    last_ns = sample->time_ns();
    squares += error_deg * error_deg;
    ++taken;
  }
  EXPECT_EQ(static_cast<std::uint64_t>(taken) + axis.left_out(), 2000U);
  EXPECT_GT(taken, 300);
  EXPECT_LT(std::sqrt(squares / taken), 0.1);  // of all of them it is 0.2 deg
}

TEST(MeasuredAxis, LeavesOutWhatIsNoAngleOrNotLater) {
  MeasuredAxis axis;
  EXPECT_TRUE(axis.add(report_of(1.0, 1'000'000, 1'200'000, 1'400'000)));
  EXPECT_FALSE(axis.add(report_of(1.0, 1'000'000, 1'200'000, 1'400'000)));
  StepperStatus unknown = report_of(1.0, 2'000'000, 2'000'000, 2'400'000);
  unknown.angle_deg = std::nan("");
  EXPECT_FALSE(axis.add(unknown));
  EXPECT_FALSE(axis.add(report_of(1.0, 3'000'000, 2'000'000, 2'400'000)));  // a clock set back
  EXPECT_EQ(axis.left_out(), 3U);
}

TEST(Sequencer, ARequestWhileBusyIsRefusedAndTheFirstGoesOn) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(4, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  const std::uint64_t second = rig.ask(1, 1);
  const std::optional<msg::Sweep> refusal = rig.await_reason(msg::PHASE_REFUSED, "busy");
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->request_id(), second);
  EXPECT_EQ(refusal->sweep_id(), 0U);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 1U);
  EXPECT_EQ(rig.sequencer.health().requests_refused, 1U);
}

TEST(Sequencer, WhatCannotBeIsRefusedWithTheReason) {
  GrblDoubleOptions slow;
  slow.settings[110] = 100 * 60;
  slow.settings[100] = 2.0;
  SequencerRig rig(slow, [](SequencerOptions& options) {
    options.sweep.return_speed_deg_s = 90.0;
    options.sweep.lines_of_mode[8] = 1;
  });
  ASSERT_TRUE(rig.ready());
  rig.ask(9, 1);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "no mode 9"));
  rig.ask(2, 0);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "0 sweeps"));
  rig.ask(7, 1);  // 11.25 deg/s are 22.5 steps/s
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "22.5 steps/s"));
  rig.ask(1, 1);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "$110=6000"));
  rig.ask(2, 1, static_cast<msg::SweepSequence>(7));
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "action sequence 7"));
  EXPECT_EQ(rig.sequencer.health().requests_refused, 5U);
  EXPECT_TRUE(rig.peer.turns().empty());
}

TEST(Sequencer, ASweepThatTheCableDoesNotAllowIsRefusedBeforeTheMotorTurns) {
  SequencerRig rig({},
                   [](SequencerOptions& options) { options.stepper.limits.cable_limit_deg = 90; });
  ASSERT_TRUE(rig.ready());
  rig.ask(1, 1);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "cable"));
  EXPECT_TRUE(rig.peer.turns().empty());
}

TEST(Sequencer, ACancelEndsTheTurnAndBringsTheShaftBack) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 5);
  const std::optional<msg::Sweep> cruising = rig.await(msg::PHASE_CRUISING);
  ASSERT_TRUE(cruising);
  rig.cancel();
  const std::optional<msg::Sweep> idle = rig.await_reason(msg::PHASE_IDLE, "cancelled");
  ASSERT_TRUE(idle);
  EXPECT_LT(idle->time_ns(), cruising->window_end_ns() + 2'000'000'000);
  const msg::Sweep slowing = rig.sweeps(msg::PHASE_DECELERATING).at(0);
  EXPECT_EQ(slowing.reason(), "cancelled");
  EXPECT_EQ(slowing.sweep_id(), cruising->sweep_id());
  EXPECT_LT(slowing.time_ns(), cruising->window_end_ns());
  const std::vector<IdealTurn> turns = rig.peer.turns();
  EXPECT_NE(turns[turns.size() - 2].cancelled_ns, 0);
  EXPECT_NEAR(turns.back().to_deg, turns.front().to_deg, 1e-6);  // the start
  EXPECT_FALSE(rig.peer.turning());
  rig.ask(1, 1);
  EXPECT_TRUE(rig.await(msg::PHASE_IDLE, 3));
  EXPECT_EQ(rig.sequencer.health().faults, 0U);
}

TEST(Sequencer, ManyCancelsAreOne) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 5);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  rig.cancel();
  ASSERT_TRUE(rig.await_reason(msg::PHASE_RETURNING, "cancelled"));
  rig.cancel();
  ASSERT_TRUE(rig.await_reason(msg::PHASE_IDLE, "cancelled"));
  EXPECT_EQ(rig.sequencer.health().faults, 0U);
  rig.cancel();
  EXPECT_TRUE(rig.await_reason(msg::PHASE_IDLE, "nothing to cancel"));
}

// Who cancels because nobody listens any more says so only where there was something to cancel.
TEST(Sequencer, ACancelTellsWhetherThereWasSomethingToCancel) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  EXPECT_FALSE(rig.sequencer.cancel());
  rig.ask(7, 5);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  EXPECT_TRUE(rig.sequencer.cancel());
  EXPECT_TRUE(rig.await_reason(msg::PHASE_IDLE, "cancelled"));
}

TEST(Sequencer, ARequestForAnotherRigOrWithoutAnIdIsRefused) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  msg::SweepRequest request;
  request.rig("other");
  request.request_id(1);
  request.count(1);
  rig.sequencer.request(request);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "rig swivel"));
  request.rig("swivel");
  request.request_id(0);
  rig.sequencer.request(request);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "no id"));
}

}  // namespace
}  // namespace swivel
