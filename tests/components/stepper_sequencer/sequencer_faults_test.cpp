#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <ostream>
#include <thread>

#include "hardware/io/clock.hpp"
#include "tests/components/stepper_sequencer/sequencer_rig.hpp"

namespace swivel {
namespace {

using namespace std::chrono_literals;
using test::GrblDouble;
using test::GrblDoubleOptions;
using test::IdealTurn;
using test::SequencerRig;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::int64_t kNsPerMillisecond = 1'000'000;

struct TroubleCase {
  const char* name;
  std::function<void(GrblDouble&)> happens;
  const char* reason;
  std::int64_t seen_within_ms;
};

void PrintTo(const TroubleCase& trouble, std::ostream* out) {  // NOLINT: gtest's name
  *out << trouble.name;
}

class MidSweep : public ::testing::TestWithParam<TroubleCase> {};

// With more than half a second of constant speed to come.
TEST_P(MidSweep, IsAFaultThatStopsTheMotorAndIsRecoveredFrom) {
  const TroubleCase& trouble = GetParam();
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  const std::uint64_t request_id = rig.ask(7, 3);
  const std::optional<msg::Sweep> cruising = rig.await(msg::PHASE_CRUISING);
  ASSERT_TRUE(cruising);
  const std::int64_t happened_ns = now_ns();
  trouble.happens(rig.peer);
  const std::optional<msg::Sweep> fault = rig.await(msg::PHASE_FAULT);
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->reason(), HasSubstr(trouble.reason));
  EXPECT_EQ(fault->request_id(), request_id);
  EXPECT_EQ(fault->sweep_id(), cruising->sweep_id());
  EXPECT_LT(fault->time_ns() - happened_ns, trouble.seen_within_ms * kNsPerMillisecond);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  EXPECT_FALSE(rig.peer.turning());
  EXPECT_EQ(rig.peer.homings(), 2);
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 0U);
  EXPECT_TRUE(rig.sweeps(msg::PHASE_DECELERATING).empty());
}

INSTANTIATE_TEST_SUITE_P(
    Trouble, MidSweep,
    ::testing::Values(
        TroubleCase{"HardLimit", [](GrblDouble& peer) { peer.raise_alarm(1); }, "ALARM:1", 300},
        TroubleCase{"Reset", [](GrblDouble& peer) { peer.reset_itself(); }, "was reset", 300},
        TroubleCase{"StopsShort", [](GrblDouble& peer) { peer.stop_short(); }, "says Idle", 300},
        TroubleCase{"Silence", [](GrblDouble& peer) { peer.fall_silent(); }, "silent", 1300}),
    [](const auto& test) { return test.param.name; });

TEST(SequencerFaults, AMotorThatDoesNotCancelIsCut) {
  SequencerRig rig({}, [](SequencerOptions& options) { options.stepper.halt_timeout = 150ms; });
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  rig.peer.deafen_to_cancel();
  rig.cancel();
  ASSERT_TRUE(rig.await(msg::PHASE_FAULT));
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 2));
  EXPECT_THAT(rig.peer.lines(), Contains("0x18"));
  const std::vector<IdealTurn> turns = rig.peer.turns();
  const auto was_cut = [](const IdealTurn& turn) { return turn.cut_ns != 0; };
  EXPECT_EQ(std::count_if(turns.begin(), turns.end(), was_cut), 1);
  rig.ask(1, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_IDLE, 3));
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 1U);
}

TEST(SequencerFaults, ALostControllerIsSeenWhileItStandsAndRequestsAreRefused) {
  SequencerRig rig({}, [](SequencerOptions& options) { options.shortest_retry_s = 0.2; });
  ASSERT_TRUE(rig.ready());
  rig.peer.unplug();
  ASSERT_TRUE(rig.await_reason(msg::PHASE_FAULT, "closed"));
  rig.ask(1, 1);
  EXPECT_TRUE(rig.await_reason(msg::PHASE_REFUSED, "not ready"));
  EXPECT_FALSE(rig.sequencer.health().ready);
  EXPECT_THAT(rig.sequencer.health().last_error, HasSubstr("/dev/pts"));
  ASSERT_TRUE(rig.await(msg::PHASE_FAULT, 3));  // it keeps trying
}

TEST(SequencerFaults, AHomingThatFailsIsTriedAgain) {
  GrblDoubleOptions once;
  once.homing_alarm = 9;
  SequencerRig rig(once);
  ASSERT_TRUE(rig.await_reason(msg::PHASE_FAULT, "home switch"));
  EXPECT_TRUE(rig.ready());
  EXPECT_EQ(rig.peer.homings(), 2);
}

TEST(SequencerFaults, ASpeedThatTheMotorNeverReachesGivesNoWindow) {
  GrblDoubleOptions sluggish;
  sluggish.turn_delay_s = 5.0;  // longer than settling and sweep take
  SequencerRig rig(sluggish, [](SequencerOptions& options) { options.longest_retry_s = 0.01; });
  ASSERT_TRUE(rig.ready());
  rig.ask(1, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_FAULT));
  EXPECT_TRUE(rig.sweeps(msg::PHASE_CRUISING).empty());
  EXPECT_TRUE(rig.axes().empty());
}

// For systemd's watchdog: the participant's own thread goes on whatever becomes of this one.
TEST(SequencerFaults, AHungMotionThreadIsSeen) {
  GrblDouble peer;
  SequencerOptions options = test::quick_options(peer);
  options.longest_silence = 1500ms;  // less than a busy machine may need between two words
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  Sequencer sequencer(options, {[&](const msg::Sweep& sweep) {
                                  if (sweep.phase() == msg::PHASE_IDLE) released.wait();
                                },
                                [](const msg::Axis&) {}});
  sequencer.start();
  EXPECT_TRUE(sequencer.works());
  const auto changes_to = [&](bool works) {
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (sequencer.works() != works && std::chrono::steady_clock::now() < deadline)
      std::this_thread::yield();
    return sequencer.works() == works;
  };
  EXPECT_TRUE(changes_to(false));
  release.set_value();
  EXPECT_TRUE(changes_to(true));
}

// However long it is: each look at the turning motor is a sign of life.
TEST(SequencerFaults, ASweepLongerThanTheLongestSilenceIsNoHang) {
  // Less than the request takes, more than a busy machine stalls.
  SequencerRig rig({}, [](SequencerOptions& options) { options.longest_silence = 3000ms; });
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 4);
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (rig.sequencer.health().sweeps_done < 4 && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(rig.sequencer.works());
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(rig.sequencer.health().sweeps_done, 4U);
}

void expect_stops_within_2_s(SequencerRig& rig) {
  const auto began = std::chrono::steady_clock::now();
  rig.sequencer.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - began, 2s);
  EXPECT_FALSE(rig.peer.turning());
  EXPECT_EQ(rig.sweeps().back().reason().find("the sequencer is stopping"), 0U);
  rig.ask(1, 1);
  EXPECT_EQ(rig.sweeps().back().phase(), msg::PHASE_REFUSED);
}

TEST(SequencerStop, WithTheMotorTurning) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  expect_stops_within_2_s(rig);
}

TEST(SequencerStop, WithAMotorThatDoesNotCancel) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_ACCELERATING));
  rig.peer.deafen_to_cancel();
  expect_stops_within_2_s(rig);
}

TEST(SequencerStop, WhileHoming) {
  GrblDoubleOptions endless;
  endless.homing_s = 1e6;
  SequencerRig rig(endless);
  ASSERT_TRUE(rig.await(msg::PHASE_HOMING));
  expect_stops_within_2_s(rig);
}

TEST(SequencerStop, WithASilentController) {
  SequencerRig rig;
  ASSERT_TRUE(rig.ready());
  rig.ask(7, 1);
  ASSERT_TRUE(rig.await(msg::PHASE_CRUISING));
  rig.peer.fall_silent();
  expect_stops_within_2_s(rig);
}

TEST(SequencerStop, WithNobodyAtTheAddress) {
  SequencerRig rig({}, [](SequencerOptions& options) {
    options.stepper.address = "/dev/does-not-exist";
    options.shortest_retry_s = 10.0;
  });
  ASSERT_TRUE(rig.await_reason(msg::PHASE_FAULT, "/dev/does-not-exist"));
  expect_stops_within_2_s(rig);
}

}  // namespace
}  // namespace swivel
