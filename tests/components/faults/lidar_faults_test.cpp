// What a lidar and its network do wrong in the middle of a sweep.
#include <gmock/gmock.h>

#include "components/common/roll.hpp"
#include "hardware/io/clock.hpp"
#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

using ::testing::HasSubstr;

const std::string kReader = "hokuyo_reader";

class LidarFaults : public FaultSuite {
 protected:
  // The sweep in the middle of which the command was given to the bench.
  static std::optional<msg::Sweep> sweep_with(const std::string& command) {
    if (!rig().go_into_a_sweep()) return std::nullopt;
    rig().bench(command);
    return rig().await(msg::PHASE_ASSEMBLED);
  }

  static void expect_incomplete_and_said(const std::optional<msg::Sweep>& sweep) {
    ASSERT_TRUE(sweep);
    EXPECT_FALSE(sweep->complete());
    EXPECT_EQ(sweep->lines_used() + sweep->lines_missing(), 40U);
    EXPECT_THAT(sweep->reason(), HasSubstr("lines missing"));
    EXPECT_TRUE(rig().await_error("cloud_assembler", "incomplete"));
    const auto attitude = rig().await_attitude(sweep->sweep_id());
    ASSERT_TRUE(attitude);
    EXPECT_EQ(attitude->lines_missing(), sweep->lines_missing());
  }

  // From the instant at which the lidar could be reached again.
  static void expect_back_within_2_s(double off_s) {
    const auto back = rig().await_health(
        kReader, [](const msg::Health& health) { return health.state() == msg::HEALTH_OK; });
    ASSERT_TRUE(back);
    EXPECT_LT(static_cast<double>(back->time_ns() - rig().marked_ns()) * 1e-9, off_s + 2.0);
  }

  static std::uint64_t count(const std::string& name) { return rig().counter(kReader, name); }
};

TEST_F(LidarFaults, APowerCycle) {
  const auto sweep = sweep_with("lidar power-cycle 2");
  EXPECT_TRUE(rig().await_error(kReader, "next attempt", 1.0));
  expect_incomplete_and_said(sweep);
  expect_back_within_2_s(2.0);
  expect_a_right_sweep(rig());
}

TEST_F(LidarFaults, AConnectionThatIsReset) {
  const auto sweep = sweep_with("lidar reset");
  EXPECT_TRUE(rig().await_error(kReader, "closed the connection", 1.0));
  expect_incomplete_and_said(sweep);
  expect_back_within_2_s(0.0);
  expect_a_right_sweep(rig());
}

TEST_F(LidarFaults, AStallOf200MillisecondsLosesNothing) {
  const auto sweep = sweep_with("lidar stall 0.2");
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(sweep->complete()) << sweep->reason();
  const auto attitude = rig().await_attitude(sweep->sweep_id());
  ASSERT_TRUE(attitude);
  EXPECT_EQ(attitude->verdict(), msg::VERDICT_GOOD) << attitude->reason();
}

TEST_F(LidarFaults, AStallThatLastsIsSeenByTheWatchdog) {
  const auto sweep = sweep_with("lidar stall 30");
  EXPECT_TRUE(rig().await_error(kReader, "no good scan for 500 ms", 1.5));
  expect_incomplete_and_said(sweep);
  expect_a_right_sweep(rig());
}

// Each costs its own scans and no others, and is counted by its reason.
TEST_F(LidarFaults, SpoiltScansAreMissingAndCountedByReason) {
  const std::uint64_t bad_sums = count("bad_sums");
  const std::uint64_t unusable = count("unusable_replies");
  const std::uint64_t lost = count("scans_lost");
  ASSERT_TRUE(rig().go_into_a_sweep());
  for (const char* command : {"lidar drop 5", "lidar half 1", "lidar bad-sums 3",
                              "lidar wrong-echo 2", "lidar status 0M 2"}) {
    rig().bench(command);
  }
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  expect_incomplete_and_said(sweep);
  EXPECT_TRUE(rig().await_error(kReader, "0M", 1.5));
  EXPECT_GE(sweep->lines_missing(), 13U);  // and what is glued to the half one
  EXPECT_LE(sweep->lines_missing(), 14U);
  ASSERT_TRUE(rig().await_health(kReader, [&](const msg::Health& health) {
    return counter_of(health, "scans_lost").value_or(0) - lost == sweep->lines_missing();
  }));
  EXPECT_GE(count("bad_sums"), bad_sums + 3);
  EXPECT_EQ(count("unusable_replies"), unusable + 2);
  expect_a_right_sweep(rig());
}

TEST_F(LidarFaults, ALaserThatGoesOffForAWhile) {
  const auto sweep = sweep_with("lidar status 10 4");
  EXPECT_TRUE(rig().await_error(kReader, "10", 1.5));
  expect_incomplete_and_said(sweep);
}

// The counter jumps to just before its wrap, and wraps within the sweep.
TEST_F(LidarFaults, StampsThatJump) {
  const std::uint64_t restarts = count("clock_restarts");
  const auto sweep = sweep_with("lidar stamp 16777000");
  ASSERT_TRUE(sweep);
  const auto attitude = rig().await_attitude(sweep->sweep_id());
  ASSERT_TRUE(attitude);
  if (sweep->complete() && attitude->verdict() == msg::VERDICT_GOOD) expect_true(rig(), *attitude);
  EXPECT_TRUE(rig().await_health(kReader, [&](const msg::Health& health) {
    return counter_of(health, "clock_restarts").value_or(0) == restarts + 1;
  }));
  expect_a_right_sweep(rig());
}

// As the counter does every 4.7 hours.
TEST_F(LidarFaults, TheStampsWrapWithinASweep) {
  constexpr std::uint32_t kWrap_ms = 1U << 24;
  constexpr std::uint32_t kUntilWrap_ms = 2000;
  constexpr int kMode = 2;  // its window is open from some 0.6 s after the request to 2.6 s
  const std::uint64_t restarts = count("clock_restarts");
  rig().bench("lidar stamp " + std::to_string(kWrap_ms - kUntilWrap_ms));
  rig().ask(kMode);
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(sweep->complete()) << sweep->reason();
  const auto attitude = rig().await_attitude(sweep->sweep_id());
  ASSERT_TRUE(attitude);
  EXPECT_EQ(attitude->verdict(), msg::VERDICT_GOOD) << attitude->reason();
  EXPECT_GT(attitude->first_device_stamp_ms(), kWrap_ms - kUntilWrap_ms) << "wrapped before";
  EXPECT_LT(kWrap_ms - attitude->first_device_stamp_ms(), 2000U) << "not within the sweep";
  expect_true(rig(), *attitude);
  EXPECT_TRUE(rig().await(msg::PHASE_IDLE));
  EXPECT_EQ(count("clock_restarts"), restarts + 1) << "the jump before it, and no other";
}

TEST_F(LidarFaults, TheBooksBalanceOnceTheLidarIsSilent) {
  expect_balanced_books(rig());
}

}  // namespace
}  // namespace swivel::test
