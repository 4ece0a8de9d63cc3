// The bench on its real wires: the orders of commands of three independent clients, what a bad
// network does, and the controller on its pty.
#include "hardware/sim/bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hardware/io/clock.hpp"
#include "tests/hardware/sim/bench_thread.hpp"
#include "tests/hardware/sim/scip_replies_by_hand.hpp"
#include "tests/support/own_path.hpp"

namespace swivel::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

BenchOptions quick_bench() {
  BenchOptions options;
  options.timing.start_latency_ms = 1.0;
  options.motor.home_time_s = 0.2;
  options.motor.boot_s = 0.02;
  options.server.reboot_s = 0.05;
  return options;
}

std::string reply_of(Client& lidar, const std::string& request) {
  lidar.send(request + "\n");
  return lidar.take_through("\n\n");
}

// Skips scans that were on their way, at most two as the vendor's library allows.
std::string reply_while_streaming(Client& lidar, const std::string& request) {
  lidar.send(request + "\n");
  std::string reply;
  for (int skipped = 0; skipped < 4; ++skipped) {
    reply = lidar.take_through("\n\n");
    if (reply.rfind(request + "\n", 0) == 0) break;
  }
  return reply;
}

std::size_t key_lines(const std::string& reply) {
  return lines_of(reply).size() - 3;  // echo, status, empty line
}

TEST(Bench, ServesTheVendorsLibrary) {
  BenchThread running(quick_bench());
  Client lidar = Client::of_lidar(running.bench.port());
  ASSERT_TRUE(lidar.connected());
  lidar.send("\n");
  EXPECT_EQ(lidar.take_for(0.14), "");
  EXPECT_EQ(reply_of(lidar, "QT"), "QT\n00P\n\n");
  const std::string parameters = reply_of(lidar, "PP");
  EXPECT_TRUE(sums_hold(parameters, false));
  EXPECT_GE(key_lines(parameters), 8U);
  for (const char* key :
       {"DMIN:", "DMAX:", "ARES:1440", "AMIN:0", "AMAX:1080", "AFRT:540", "SCAN:2400"}) {
    EXPECT_THAT(parameters, HasSubstr(std::string("\n") + key));
  }
  EXPECT_GE(key_lines(reply_of(lidar, "VV")), 5U);
  const std::string state = reply_of(lidar, "II");
  EXPECT_EQ(key_lines(state), 7U);
  EXPECT_THAT(state, HasSubstr("\nSTAT:sensor is working normally"));
  EXPECT_THAT(reply_of(lidar, "TM0"), HasSubstr("\n00P"));
  EXPECT_EQ(lines_of(reply_of(lidar, "TM1"))[2].size(), 5U);
  EXPECT_THAT(reply_of(lidar, "TM2"), HasSubstr("\n00P"));
  EXPECT_EQ(reply_of(lidar, "MD0000108001000"), "MD0000108001000\n00P\n\n");
  for (int scan = 0; scan < 3; ++scan) {
    const std::string frame = lidar.take_through("\n\n");
    EXPECT_THAT(frame, StartsWith("MD0000108001000\n99b\n"));
    EXPECT_EQ(frame.size(), 16U + 4U + 6U + 3346U);
    EXPECT_TRUE(sums_hold(frame, true));
  }
  EXPECT_EQ(reply_while_streaming(lidar, "QT"), "QT\n00P\n\n");
  EXPECT_EQ(lidar.take_for(0.06), "");
  EXPECT_THAT(reply_of(lidar, "BM"), HasSubstr("\n00P"));
  EXPECT_THAT(reply_of(lidar, "GD0000108001"), StartsWith("GD0000108001\n00P\n"));
  EXPECT_THAT(reply_of(lidar, "%SL"), HasSubstr("\n00P"));
  EXPECT_THAT(reply_of(lidar, "RB"), HasSubstr("\n01Q"));
  EXPECT_THAT(reply_of(lidar, "RB"), HasSubstr("\n00P"));
  EXPECT_TRUE(lidar.wait_closed(2.0));
}

TEST(Bench, ServesMrptAlsoWhileStreaming) {
  BenchThread running(quick_bench());
  Client lidar = Client::of_lidar(running.bench.port());
  for (int round = 0; round < 2; ++round) {
    for (const char* request : {"QT", "QT", "SCIP2.0", "BM", "HS0", "PP", "VV"}) {
      const std::string reply = reply_while_streaming(lidar, request);
      EXPECT_THAT(reply, StartsWith(std::string(request) + "\n"));
      EXPECT_TRUE(sums_hold(reply, true)) << request;
    }
    EXPECT_EQ(reply_of(lidar, "MD0000108001000"), "MD0000108001000\n00P\n\n");
    EXPECT_THAT(lidar.take_through("\n\n"), StartsWith("MD0000108001000\n99b\n"));
  }
}

TEST(Bench, ServesHokuyolx) {
  BenchThread running(quick_bench());
  Client lidar = Client::of_lidar(running.bench.port());
  EXPECT_EQ(lines_of(reply_of(lidar, "%ST"))[2], std::string("000") + sum_of("000"));
  reply_of(lidar, "TM0");
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(sums_hold(reply_of(lidar, "TM1"), true));
  reply_of(lidar, "TM2");
  for (const char* request : {"PP", "BM", "VV", "II"}) {
    EXPECT_TRUE(sums_hold(reply_of(lidar, request), true)) << request;
  }
  EXPECT_EQ(values_of(reply_of(lidar, "GD0000108000"), 3).size(), 1081U);
  EXPECT_EQ(values_of(reply_of(lidar, "GE0000108000"), 3).size(), 2162U);
  reply_of(lidar, "MD0000108000002");
  EXPECT_THAT(lidar.take_through("\n\n"), StartsWith("MD0000108000001\n99b\n"));
  EXPECT_THAT(lidar.take_through("\n\n"), StartsWith("MD0000108000000\n99b\n"));
  reply_of(lidar, "ME0000108000000");
  EXPECT_EQ(values_of(lidar.take_through("\n\n"), 3).size(), 2162U);
  EXPECT_EQ(reply_while_streaming(lidar, "QT"), "QT\n00P\n\n");
}

TEST(Bench, StartsQuietForEachClientAndServesOneAtATime) {
  BenchThread running(quick_bench());
  auto first = std::make_unique<Client>(Client::of_lidar(running.bench.port()));
  reply_of(*first, "MD0000108001000");
  Client second = Client::of_lidar(running.bench.port());
  second.send("QT\n");
  EXPECT_EQ(second.take_for(0.1), "");
  first.reset();
  EXPECT_EQ(second.take_through("\n\n"), "QT\n00P\n\n");
  EXPECT_EQ(second.take_for(0.1), "");
}

TEST(Bench, ComesBackOnItsPortAfterAReboot) {
  BenchThread running(quick_bench());
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "RB");
  reply_of(lidar, "RB");
  ASSERT_TRUE(lidar.wait_closed(2.0));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::string reply;
  while (reply.empty() && std::chrono::steady_clock::now() < deadline) {
    Client again = Client::of_lidar(running.bench.port());
    if (again.connected()) reply = reply_of(again, "QT");
  }
  EXPECT_EQ(reply, "QT\n00P\n\n");
}

TEST(Bench, PacesItsScansAndCrossesTheWrap) {
  BenchOptions options = quick_bench();
  options.timing.stamp_start_ms = 16777216.0 - 300.0;
  options.timing.clock_gain_ppm = 0.0;
  BenchThread running(options);
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "MD0000108001000");
  bool wrapped = false;
  unsigned before = 0;
  for (int scan = 0; scan < 20; ++scan) {
    const auto lines = lines_of(lidar.take_through("\n\n"));
    ASSERT_GT(lines.size(), 3U);
    const unsigned stamp = value_of(lines[2].substr(0, 4));
    const unsigned step = (stamp - before) & 0xFFFFFFU;
    EXPECT_TRUE(scan == 0 || step == 25 || step == 26) << step;
    wrapped = wrapped || (scan > 0 && stamp < before);
    before = stamp;
  }
  EXPECT_TRUE(wrapped);
}

int count_good_frames(const BenchOptions& options, int frames) {
  BenchThread running(options);
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "MD0000108001000");
  int good = 0;
  for (int i = 0; i < frames; ++i) good += sums_hold(lidar.take_through("\n\n"), true) ? 1 : 0;
  return good;
}

TEST(BenchMisbehaves, SpoilsEachNthSum) {
  BenchOptions options = quick_bench();
  options.server.misbehaviour.bad_sum_every = 3;
  EXPECT_EQ(count_good_frames(options, 9), 6);
}

TEST(BenchMisbehaves, ChopsButLosesNothing) {
  BenchOptions options = quick_bench();
  options.server.misbehaviour.chop = true;
  EXPECT_EQ(count_good_frames(options, 4), 4);
}

TEST(BenchMisbehaves, GluesFrames) {
  BenchOptions options = quick_bench();
  options.server.misbehaviour.glue_frames = 3;
  BenchThread running(options);
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "MD0000108001000");
  const auto start = std::chrono::steady_clock::now();
  ASSERT_FALSE(lidar.take_through("\n\n").empty());
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(60));
  EXPECT_FALSE(lidar.take_through("\n\n", 0.02).empty());
  EXPECT_FALSE(lidar.take_through("\n\n", 0.02).empty());
}

TEST(BenchMisbehaves, StallsAndCloses) {
  BenchOptions options = quick_bench();
  options.server.misbehaviour.stall_every = 2;
  options.server.misbehaviour.stall_s = 0.3;
  options.server.misbehaviour.close_every = 5;
  BenchThread running(options);
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "MD0000108001000");
  ASSERT_FALSE(lidar.take_through("\n\n").empty());
  const auto start = std::chrono::steady_clock::now();
  ASSERT_FALSE(lidar.take_through("\n\n").empty());
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(250));
  EXPECT_TRUE(lidar.wait_closed(5.0));
}

std::vector<std::string> file_lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(Bench, WritesTheTruthOfEachLineItSends) {
  BenchOptions options = quick_bench();
  options.truth_path = own_path("truth.csv");
  std::vector<unsigned> stamps;
  const std::int64_t before_ns = now_ns();
  {
    BenchThread running(options);
    Client lidar = Client::of_lidar(running.bench.port());
    reply_of(lidar, "MD0000108001003");
    for (int i = 0; i < 3; ++i) {
      stamps.push_back(value_of(lines_of(lidar.take_through("\n\n"))[2].substr(0, 4)));
    }
  }
  auto lines = file_lines(options.truth_path);
  EXPECT_EQ(lines[0], "# seed 1");
  EXPECT_EQ(lines[1], "# alpha_deg 29.36");
  while (!lines.empty() && lines.front().front() == '#') lines.erase(lines.begin());
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "device_stamp_ms,beam0_time_ns,phi_deg");
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string& row = lines[i + 1];
    EXPECT_THAT(row, StartsWith(std::to_string(stamps[i]) + ","));
    EXPECT_THAT(row, ::testing::EndsWith(",-60.000000"));
    const auto time_ns = std::stoll(row.substr(row.find(',') + 1));
    EXPECT_GT(time_ns, before_ns);
    EXPECT_LT(time_ns, now_ns());
  }
  std::filesystem::remove(options.truth_path);
}

TEST(Bench, ConversesOnItsPtyAndTurnsTheShaft) {
  BenchOptions options = quick_bench();
  options.stepper_link = own_path("bench_stepper");
  options.truth_path = own_path("turn.csv");
  {
    BenchThread running(options);
    Client stepper = Client::of_stepper(options.stepper_link);
    ASSERT_TRUE(stepper.connected());
    EXPECT_THAT(stepper.take_through("unlock]\r\n"), HasSubstr("Grbl 1.1h ['$' for help]"));
    stepper.send("$X\n");
    EXPECT_THAT(stepper.take_through("ok\r\n"), HasSubstr("Unlocked"));
    stepper.send("$H\n");
    EXPECT_EQ(stepper.take_through("\r\n"), "ok\r\n");
    stepper.send("$J=G91 X180 F10800\n");
    EXPECT_EQ(stepper.take_through("\r\n"), "ok\r\n");
    Client lidar = Client::of_lidar(running.bench.port());
    reply_of(lidar, "MD0000108001020");
    for (int i = 0; i < 20; ++i) ASSERT_FALSE(lidar.take_through("\n\n").empty());
    stepper.send("\x85");
    std::string report;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (report.rfind("<Idle|", 0) != 0 && std::chrono::steady_clock::now() < deadline) {
      stepper.send("?");
      report = stepper.take_through(">\r\n");
    }
    EXPECT_THAT(report, StartsWith("<Idle|"));
  }
  const auto lines = file_lines(options.truth_path);
  const auto phi = [&](std::size_t i) {
    return std::stod(lines[i].substr(lines[i].rfind(',') + 1));
  };
  const std::size_t last = lines.size() - 1;
  EXPECT_NEAR(phi(last) - phi(last - 1), 180.0 * 0.02504, 0.012);  // a line of mode 1
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(options.stepper_link)));
  std::filesystem::remove(options.truth_path);
}

TEST(Bench, ResetsTheControllerWhenItsPortIsOpened) {
  BenchThread running(quick_bench());
  for (int i = 0; i < 3; ++i) {
    Client stepper = Client::of_stepper(running.bench.stepper_path());
    EXPECT_THAT(stepper.take_through("unlock]\r\n"), HasSubstr("Grbl 1.1h"));
    stepper.send("$X\n");
    EXPECT_THAT(stepper.take_through("ok\r\n"), HasSubstr("Unlocked"));
    stepper.send("$J=G91 X5 F600\n");
    EXPECT_EQ(stepper.take_through("\r\n"), "ok\r\n");
  }
}

TEST(Bench, StopsAtOnce) {
  BenchThread running(quick_bench());
  Client lidar = Client::of_lidar(running.bench.port());
  reply_of(lidar, "MD0000108001000");
  const auto start = std::chrono::steady_clock::now();
  running.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(Bench, SaysWhyItCannotStart) {
  BenchOptions options = quick_bench();
  BenchThread running(options);
  options.server.port = running.bench.port();
  try {
    const Bench second(options);
    FAIL() << "two on one port";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("choose another --port"));
  }
  options.server.port = 0;
  options.truth_path = "/nowhere/truth.csv";
  EXPECT_THROW(Bench{options}, std::runtime_error);
}

}  // namespace
}  // namespace swivel::sim
