#include "hardware/lidar/scip_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hardware/lidar/scripted_lidar.hpp"

namespace swivel::scip {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr SessionTimeouts kHasty{milliseconds(500), milliseconds(500), milliseconds(200)};

TEST(ScipSession, AsksOneThingAfterTheOther) {
  const ScriptedLidar lidar({});
  auto session = Session::open(lidar.address(), kHasty, nullptr);
  ASSERT_TRUE(session) << session.reason();
  EXPECT_EQ(session->identify()->product, "Scripted");
  EXPECT_EQ(session->read_parameters()->beams(), 1081);
  EXPECT_EQ(session->read_state()->status, "sensor is working normally");
  EXPECT_TRUE(session->reset());
  EXPECT_TRUE(session->reboot());
  session->leave();
  EXPECT_EQ(lidar.requests(),
            (std::vector<std::string>{"QT", "VV", "PP", "II", "RS", "RB", "RB", "QT"}));
}

TEST(ScipSession, ClockReadingsLieBetweenSendingAndReceiving) {
  const ScriptedLidar lidar({});
  auto session = Session::open(lidar.address(), kHasty, nullptr);
  ASSERT_TRUE(session) << session.reason();
  const auto readings = session->read_clock(10);
  ASSERT_TRUE(readings) << readings.reason();
  ASSERT_EQ(readings->size(), 10U);
  for (std::size_t later = 1; later < 10; ++later) {
    EXPECT_LE((*readings)[later].sent_ns, (*readings)[later].received_ns);
    EXPECT_LE((*readings)[later - 1].received_ns, (*readings)[later].sent_ns);
    EXPECT_LE((*readings)[later - 1].stamp_ms, (*readings)[later].stamp_ms);
  }
  EXPECT_EQ(lidar.requests().back(), "TM2");
}

TEST(ScipSession, AScanGluedToItsAcknowledgementIsKept) {
  LidarScript script;
  script.glues = true;
  const ScriptedLidar lidar(script);
  auto session = Session::open(lidar.address(), kHasty, nullptr);
  ASSERT_TRUE(session) << session.reason();
  ASSERT_TRUE(session->start_scans("ME0000108001000"));
  const auto first = session->next_reply(std::chrono::steady_clock::now() + milliseconds(500));
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->reply.status, "99");
}

TEST(ScipSession, RefusalsAreWords) {
  LidarScript script;
  script.scan_status = "04";
  const ScriptedLidar lidar(script);
  auto session = Session::open(lidar.address(), kHasty, nullptr);
  ASSERT_TRUE(session) << session.reason();
  EXPECT_THAT(session->start_scans("ME0000108001000").reason(), HasSubstr("out of range"));
}

TEST(ScipSession, SilenceAtTheDeadlineIsNoReply) {
  const ScriptedLidar lidar({});
  auto session = Session::open(lidar.address(), kHasty, nullptr);
  ASSERT_TRUE(session) << session.reason();
  const auto next = session->next_reply(std::chrono::steady_clock::now() + milliseconds(20));
  ASSERT_TRUE(next) << next.reason();
  EXPECT_FALSE(*next);
}

}  // namespace
}  // namespace swivel::scip
