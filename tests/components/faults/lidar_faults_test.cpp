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

TEST_F(LidarFaults, TheBooksBalanceOnceTheLidarIsSilent) {
  rig().bench("lidar power-cycle 4");
  const auto balanced = rig().await_health(
      "cloud_assembler",
      [](const msg::Health& health) {
        const auto value = [&](const char* name) { return counter_of(health, name).value_or(0); };
        return health.time_ns() > rig().marked_ns() + 2'000'000'000 &&
               value("lines_received") == value("lines_used") + value("lines_outside") +
                                              value("lines_rejected") + value("lines_late") +
                                              value("lines_waiting");
      },
      4.0);
  ASSERT_TRUE(balanced);
  EXPECT_GT(counter_of(*balanced, "lines_received"), 100U);
  EXPECT_EQ(counter_of(*balanced, "lines_received"), count("lines_written"));
  EXPECT_EQ(counter_of(*balanced, "samples_lost"), 0U);
  EXPECT_EQ(count("lines_not_written"), 0U);
  EXPECT_EQ(count("scans"), count("lines_written"));
}

}  // namespace
}  // namespace swivel::test
