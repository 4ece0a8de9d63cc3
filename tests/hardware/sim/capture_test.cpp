// What was captured of the wires, served again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>

#include "hardware/lidar/scip_client.hpp"
#include "hardware/sim/capture_bench.hpp"
#include "hardware/stepper/grbl_stepper.hpp"
#include "tests/hardware/sim/bench_thread.hpp"

namespace swivel::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = CapturedPiece::Kind;

std::vector<std::string> requests_of(const Conversation& conversation) {
  std::vector<std::string> requests;
  for (const Exchange& exchange : conversation.exchanges) requests.push_back(exchange.request);
  return requests;
}

// All that came after each request.
std::vector<std::string> answers_of(const Conversation& conversation) {
  std::vector<std::string> answers;
  for (const Exchange& exchange : conversation.exchanges) {
    answers.emplace_back();
    for (const Answer& answer : exchange.answers) answers.back() += answer.bytes;
  }
  return answers;
}

const std::vector<CapturedPiece> kTalk{{Kind::kFromDevice, 10, 0, "Grbl 1.1h\r\n"},
                                       {Kind::kToDevice, 20, 0, "$$\n"},
                                       {Kind::kFromDevice, 30, 11, "$100=88\r\nok\r\n"},
                                       {Kind::kToDevice, 40, 3, "?"},
                                       {Kind::kFromDevice, 50, 24, "<Idle>\r\n"}};

TEST(Conversation, IsTheSameHoweverTheBytesCameAndHoweverOften) {
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    std::vector<CapturedPiece> pieces;
    for (const CapturedPiece& piece : kTalk) {
      for (std::size_t at = 0; at < piece.bytes.size();) {
        const std::size_t size = 1 + random() % piece.bytes.size();
        pieces.push_back(
            {piece.kind, piece.time_ns, piece.offset + at, piece.bytes.substr(at, size)});
        if (random() % 3 == 0) pieces.push_back(pieces[random() % pieces.size()]);
        at += size;
      }
    }
    const Conversation conversation = conversation_of(pieces, 0, kGrblAtOnce);
    EXPECT_THAT(requests_of(conversation), ElementsAre("", "$$\n", "?"));
    EXPECT_THAT(answers_of(conversation),
                ElementsAre("Grbl 1.1h\r\n", "$100=88\r\nok\r\n", "<Idle>\r\n"));
    EXPECT_EQ(conversation.bytes_missing, 0U);
  }
}

// A stream of scans, ten a second; those of [from, to) were not heard.
Conversation stream_without(int from, int to) {
  std::vector<CapturedPiece> pieces{{Kind::kToDevice, 1000, 0, "ME\n"},
                                    {Kind::kFromDevice, 2000, 0, "ack!"}};
  for (int scan = 0; scan < 100; ++scan) {
    if (scan >= from && scan < to) continue;
    const auto place = static_cast<std::uint64_t>(scan);
    pieces.push_back({Kind::kFromDevice, 2000 + (scan + 1) * std::int64_t{100'000'000},
                      4 * (place + 1), "scan"});
  }
  return conversation_of(pieces, 0, "");
}

TEST(Conversation, AShortHoleStaysOne) {
  const Conversation conversation = stream_without(50, 51);
  EXPECT_EQ(conversation.bytes_missing, 4U);
  EXPECT_EQ(conversation.bytes_left_out, 0U);
  const std::vector<Answer>& answers = conversation.exchanges.back().answers;
  ASSERT_EQ(answers.size(), 100U);
  EXPECT_EQ(answers[51].delay_ns - answers[50].delay_ns, 200'000'000);
}

TEST(Conversation, ALongHoleIsNotWaitedFor) {
  const Conversation conversation = stream_without(10, 90);
  EXPECT_EQ(conversation.bytes_missing, 320U);
  EXPECT_EQ(conversation.bytes_left_out, 40U);
  const std::vector<Answer>& answers = conversation.exchanges.back().answers;
  ASSERT_EQ(answers.size(), 11U) << "the acknowledgement, and what was heard after the hole";
  EXPECT_EQ(answers[0].bytes, "ack!");
  EXPECT_LT(answers[1].delay_ns, 100'000'000);
  EXPECT_EQ(answers[2].delay_ns - answers[1].delay_ns, 100'000'000);
}

class CapturedDeviceTest : public testing::Test {
 protected:
  std::string ask(const std::string& request) {
    now_ns_ += 1000;
    device_.receive(request, now_ns_);
    now_ns_ += 1000;
    device_.advance(now_ns_);
    return device_.take_output();
  }

  std::vector<std::string> news_;
  std::int64_t now_ns_ = 1'000'000;
  CapturedDevice device_{"stepper",
                         {{{{"", {{0, "hello"}}},
                            {"$H\n", {{10, "ok"}}},
                            {"?", {{10, "<Jog>"}}},
                            {"?", {{10, "<Idle>"}}},
                            {"$J\n", {{10, "o"}, {20, "k"}}}},
                           0}},
                         kGrblAtOnce,
                         [this](const std::string& words) { news_.push_back(words); }};
};

TEST_F(CapturedDeviceTest, SaysTheSameAsQuickly) {
  device_.power_up(now_ns_);
  device_.advance(now_ns_);
  EXPECT_EQ(device_.take_output(), "hello");
  device_.receive("$H\n", now_ns_);
  device_.advance(now_ns_ + 9);
  EXPECT_EQ(device_.take_output(), "");
  EXPECT_EQ(device_.next_event_ns(now_ns_ + 9), now_ns_ + 10);
  device_.advance(now_ns_ + 10);
  EXPECT_EQ(device_.take_output(), "ok");
  EXPECT_EQ(ask("?"), "<Jog>");
  EXPECT_EQ(ask("?"), "<Idle>");
  EXPECT_EQ(ask("$J\n"), "ok");
  EXPECT_THAT(news_, IsEmpty());
}

TEST_F(CapturedDeviceTest, MayBeAskedMoreOrLessOftenHowItStands) {
  device_.power_up(now_ns_);
  ask("$H\n");
  EXPECT_EQ(ask("?"), "<Jog>");
  EXPECT_EQ(ask("$J\n"), "ok") << "one question less";
  EXPECT_EQ(ask("?"), "<Jog>") << "one more";
  EXPECT_THAT(news_, IsEmpty());
}

TEST(CapturedDevice, AStreamGoesOnWithWhatWasCapturedAtThatTime) {
  std::vector<Answer> scans;
  constexpr std::int64_t kPeriod_ns = 25'000'000;
  for (int scan = 0; scan < 200; ++scan) {
    const std::int64_t delay_ns = (scan + 1) * kPeriod_ns;
    scans.push_back({delay_ns, "ME\n" + std::to_string(scan), 1000 + delay_ns});
  }
  CapturedDevice lidar("lidar", {{{{"", {}, 0}, {"ME\n", scans, 1000}}, 0}}, "", [](auto&) {});
  std::int64_t now_ns = 5'000'000'000;
  lidar.power_up(now_ns);
  lidar.receive("ME\n", now_ns);
  for (const int captured_scan : {100, 101, 30, 180}) {
    lidar.align(1000 + (captured_scan + 1) * kPeriod_ns, now_ns);
    lidar.take_output();
    now_ns += kPeriod_ns;
    lidar.advance(now_ns);
    EXPECT_THAT(lidar.take_output(), testing::EndsWith("ME\n" + std::to_string(captured_scan + 1)));
  }
}

TEST_F(CapturedDeviceTest, SaysWhatIsNotAsInTheCapture) {
  device_.power_up(now_ns_);
  EXPECT_EQ(ask(""), "hello");
  EXPECT_EQ(ask("$X\n"), "");
  EXPECT_EQ(ask("$J\n"), "ok");
  EXPECT_EQ(device_.differences(), 2U);
  ASSERT_EQ(news_.size(), 2U);
  EXPECT_EQ(news_[0], "stepper: '$X' was sent where the capture has '$H': no answer");
  EXPECT_THAT(news_[1], HasSubstr("is left out"));
  device_.power_up(now_ns_);
  EXPECT_EQ(ask(std::string(100'000, 'x')), "hello");
  EXPECT_THAT(news_.back(), HasSubstr("no line end"));
  EXPECT_EQ(ask("$H\n"), "ok") << "anew";
}

// The pieces of one wire's first connection.
class Tapped {
 public:
  WireTap tap() {
    return [this](const WireEvent& event) {
      if (event.kind == WireEvent::Kind::kOpened) opened_ns_ = event.time_ns;
      const bool sent = event.kind == WireEvent::Kind::kSent;
      if (!sent && event.kind != WireEvent::Kind::kReceived) return;
      std::uint64_t& passed = sent ? sent_ : received_;
      pieces_.push_back({sent ? Kind::kToDevice : Kind::kFromDevice, event.time_ns, passed,
                         std::string(event.bytes)});
      passed += event.bytes.size();
    };
  }
  Conversation conversation(const std::string& at_once) const {
    return conversation_of(pieces_, opened_ns_, at_once);
  }

 private:
  std::vector<CapturedPiece> pieces_;
  std::int64_t opened_ns_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t received_ = 0;
};

constexpr std::size_t kScans = 20;

std::vector<LidarScan> scans_of(int port, const WireTap& tap = {}) {
  ScipClientOptions options;
  options.address = "tcp://127.0.0.1:" + std::to_string(port);
  options.tap = tap;
  std::mutex mutex;
  std::condition_variable came;
  std::vector<LidarScan> scans;
  ScipClient client(
      options,
      [&](const LidarScan& scan) {
        const std::lock_guard lock(mutex);
        scans.push_back(scan);
        came.notify_one();
      },
      [](const LidarReport&) {});
  std::thread session([&] { client.run(); });
  {
    std::unique_lock lock(mutex);
    came.wait_for(lock, std::chrono::seconds(10), [&] { return scans.size() >= kScans; });
  }
  client.stop();
  session.join();
  EXPECT_EQ(client.counters().lost_scans, 0U);
  return scans;
}

// What the stepper answers to a homing and a turn: where it stands after each.
std::vector<double> turns_of(const std::string& path, const WireTap& tap = {}) {
  GrblStepperOptions options;
  options.address = path;
  options.tap = tap;
  options.limits.cable_limit_deg = 300.0;
  options.limits.max_speed_deg_s = 180.0;
  GrblStepper stepper(options);
  for (const Outcome& done : {stepper.connect(), stepper.home()}) EXPECT_TRUE(done);
  std::vector<double> angles_deg{stepper.status()->angle_deg};
  const Result<Turn> turn = stepper.move_to(20.0, 100.0);
  EXPECT_TRUE(turn) << turn.reason();
  const Result<StepperStatus> stands = stepper.wait_idle(std::chrono::seconds(5));
  EXPECT_TRUE(stands) << stands.reason();
  if (stands) angles_deg.push_back(stands->angle_deg);
  return angles_deg;
}

class CaptureBenchThread {
 public:
  explicit CaptureBenchThread(CaptureBenchOptions options)
      : bench(std::move(options), [this](const std::string& words) { news.push_back(words); }),
        thread_([this] { bench.run(stop_); }) {}
  ~CaptureBenchThread() { stop(); }
  void stop() {
    stop_.notify();
    if (thread_.joinable()) thread_.join();
  }

  std::vector<std::string> news;  // once stopped
  CaptureBench bench;

 private:
  WakeUp stop_;
  std::thread thread_;
};

TEST(CaptureBench, GivesTheScansAndTheTurnsThatWereCaptured) {
  BenchOptions options;
  options.timing.start_latency_ms = 1.0;
  options.motor.home_time_s = 0.1;
  options.motor.boot_s = 0.02;
  Tapped lidar;
  Tapped stepper;
  BenchThread original(options);
  const auto scans = scans_of(original.bench.port(), lidar.tap());
  const auto turns = turns_of(original.bench.stepper_path(), stepper.tap());
  original.stop();
  ASSERT_GE(scans.size(), kScans);

  CaptureBenchThread again({{lidar.conversation("")}, {stepper.conversation(kGrblAtOnce)}, 0, {}});
  const auto scans_again = scans_of(again.bench.port());
  const auto turns_again = turns_of(again.bench.stepper_path());
  again.stop();
  ASSERT_GE(scans_again.size(), kScans);
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    EXPECT_EQ(scans_again[scan].device_stamp_ms, scans[scan].device_stamp_ms);
    EXPECT_EQ(scans_again[scan].ranges_mm, scans[scan].ranges_mm);
    EXPECT_EQ(scans_again[scan].intensities, scans[scan].intensities);
  }
  EXPECT_EQ(turns_again, turns);
  EXPECT_THAT(again.news, IsEmpty());
}

}  // namespace
}  // namespace swivel::sim
