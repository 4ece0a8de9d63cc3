#include "hardware/lidar/scip_client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <thread>

#include "tests/hardware/lidar/scripted_lidar.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

ScipClientOptions hasty_options(const std::string& address) {
  ScipClientOptions options;
  options.address = address;
  options.timeouts = {milliseconds(500), milliseconds(150), milliseconds(100)};
  options.first_scan_timeout = milliseconds(300);
  options.watchdog_scan_periods = 30.0;  // 150 ms
  options.shortest_backoff = milliseconds(100);
  options.longest_backoff = milliseconds(400);
  options.clock_readings = 5;
  return options;
}

// A client on a thread of its own, and what it told.
class RunningClient {
 public:
  explicit RunningClient(const ScipClientOptions& options)
      : client_(
            options, [this](const LidarScan& scan) { note(scan); },
            [this](const LidarReport& report) { note(report); }),
        thread_([this] { client_.run(); }) {}

  ~RunningClient() { stop(); }

  void stop() {
    client_.stop();
    if (thread_.joinable()) thread_.join();
  }

  bool wait_for_scans(std::size_t count) {
    return wait([=] { return scans_.size() >= count; });
  }
  // Words of a report in that state that hold `part`.
  bool wait_for_words(LidarState state, const std::string& part) {
    return wait([=] {
      return std::any_of(reports_.begin(), reports_.end(), [&](const LidarReport& report) {
        return report.state == state && report.words.find(part) != std::string::npos;
      });
    });
  }
  std::vector<LidarScan> scans() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return scans_;
  }
  std::vector<LidarReport> reports() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return reports_;
  }
  const ScipClient& client() const { return client_; }

 private:
  template <class Told>
  void note(const Told& told) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if constexpr (std::is_same_v<Told, LidarScan>) scans_.push_back(told);
    if constexpr (std::is_same_v<Told, LidarReport>) reports_.push_back(told);
    changed_.notify_all();
  }
  template <class Condition>
  bool wait(Condition condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), condition);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<LidarScan> scans_;
  std::vector<LidarReport> reports_;
  ScipClient client_;
  std::thread thread_;
};

bool is_true_scan(const LidarScan& scan) {
  if (scan.ranges_mm.size() != 1081 || scan.intensities.size() != 1081) return false;
  for (int beam = 0; beam < 1081; ++beam) {
    const auto which = static_cast<std::size_t>(beam);
    if (scan.ranges_mm[which] != ScriptedLidar::range_mm(beam)) return false;
    if (scan.intensities[which] != ScriptedLidar::intensity(beam)) return false;
  }
  return true;
}

// The client must get true scans from this lidar, and nothing else.
LidarCounters stream_from(const LidarScript& script) {
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_scans(40));
  running.stop();
  const std::vector<LidarScan> scans = running.scans();
  EXPECT_TRUE(std::all_of(scans.begin(), scans.end(), is_true_scan));
  for (std::size_t later = 1; later < scans.size(); ++later)
    EXPECT_GT(scans[later].beam0_time_ns, scans[later - 1].beam0_time_ns);
  return running.client().counters();
}

// The client must never get a scan from this lidar, say why, and go on trying.
void expect_refusal(const LidarScript& script, const std::string& words) {
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, words)) << [&] {
    std::string all;
    for (const LidarReport& report : running.reports()) all += report.words + "\n";
    return all;
  }();
  EXPECT_TRUE(running.wait_for_words(LidarState::kConnecting, "connecting"));
  running.stop();
  EXPECT_TRUE(running.scans().empty());
  EXPECT_GE(lidar.connections(), 1);
}

TEST(ScipClient, AGoodSensorStreamsAndIsLeftQuiet) {
  const ScriptedLidar lidar({});
  RunningClient running(hasty_options(lidar.address()));
  ASSERT_TRUE(running.wait_for_scans(40));
  running.stop();
  const LidarScan scan = running.scans().front();
  EXPECT_TRUE(is_true_scan(scan));
  EXPECT_DOUBLE_EQ(scan.first_beam_angle_deg, -135.0);
  EXPECT_DOUBLE_EQ(scan.beam_step_deg, 0.25);
  EXPECT_NEAR(scan.scan_period_ns, 5e6, 0.05e6);
  EXPECT_DOUBLE_EQ(scan.beam_period_ns, scan.scan_period_ns / 1440);
  EXPECT_EQ(scan.range_min_mm, 20);
  EXPECT_EQ(scan.range_max_mm, 30000);
  EXPECT_EQ(running.client().identity()->serial_number, "S123");
  EXPECT_EQ(running.client().counters().bad_sums + running.client().counters().reconnects, 0U);
  EXPECT_EQ(running.reports().back().state, LidarState::kStopped);
  const std::vector<std::string> requests = lidar.requests();
  EXPECT_EQ(requests.front(), "QT");
  EXPECT_EQ(requests.back(), "QT");
  EXPECT_THAT(requests, Contains("ME0000108001000"));
  EXPECT_THAT(requests, Not(Contains("BM")));
}

// Stamps and TM of the scripted lidar count the same clock, and a scan is sent when its turn is
// over: beam 0 was an eighth of a turn after the stamp, hence 7/8 of a turn before arrival.
TEST(ScipClient, TheStampsOriginMovesBeam0) {
  for (const auto& [origin, turns] :
       {std::pair(StampOrigin::kRearCentre, 7.0 / 8.0), std::pair(StampOrigin::kFirstBeam, 1.0)}) {
    LidarScript script;
    script.scan_period_ms = 25;
    const ScriptedLidar lidar(script);
    ScipClientOptions options = hasty_options(lidar.address());
    options.stamp_origin = origin;
    options.clock_readings = 20;
    RunningClient running(options);
    ASSERT_TRUE(running.wait_for_scans(20));
    running.stop();
    double soonest_ms = 1e9;
    for (const LidarScan& scan : running.scans())
      soonest_ms = std::min(soonest_ms,
                            static_cast<double>(scan.arrival_time_ns - scan.beam0_time_ns) * 1e-6);
    EXPECT_NEAR(soonest_ms, 25.0 * turns, 1.5);
  }
}

TEST(ScipClient, SingleBytesAreAsGoodAsWholeReplies) {
  LidarScript script;
  script.chunk_bytes = 1;
  script.scan_period_ms = 25;  // 6700 system calls a scan
  EXPECT_EQ(stream_from(script).resyncs, 0U);
}

TEST(ScipClient, RepliesGluedTogetherAreTakenApart) {
  LidarScript script;
  script.glues = true;
  EXPECT_EQ(stream_from(script).resyncs, 0U);
}

TEST(ScipClient, TheFirstQuitMayBeIgnored) {
  LidarScript script;
  script.ignored_quits = 1;
  EXPECT_EQ(stream_from(script).reconnects, 0U);
}

TEST(ScipClient, ALaserThatIsOffIsLit) {
  LidarScript script;
  script.wants_laser_on = true;
  EXPECT_EQ(stream_from(script).reconnects, 0U);
}

TEST(ScipClient, WithoutTheClockTimesComeFromArrivals) {
  LidarScript script;
  script.answers_clock = false;
  EXPECT_EQ(stream_from(script).reconnects, 0U);
}

TEST(ScipClient, BadSumsCostTheirScansAndAreCounted) {
  LidarScript script;
  script.bad_sum_every = 4;
  const LidarCounters counters = stream_from(script);
  EXPECT_GE(counters.bad_sums, 10U);
  EXPECT_EQ(counters.resyncs, counters.bad_sums);
  EXPECT_NEAR(static_cast<double>(counters.lost_scans), static_cast<double>(counters.bad_sums), 1);
  EXPECT_EQ(counters.reconnects, 0U);
}

TEST(ScipClient, AStallIsFoundByTheWatchdog) {
  LidarScript script;
  script.stall_after = 10;
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "no good scan for 150 ms"));
  EXPECT_TRUE(running.wait_for_scans(30));
  EXPECT_EQ(running.client().counters().reconnects, 1U);
}

TEST(ScipClient, GarbageWithoutEndIsFoundByTheWatchdogToo) {
  LidarScript script;
  script.garbage_instead = true;
  expect_refusal(script, "no good scan for 300 ms");
}

TEST(ScipClient, AClosedConnectionIsOpenedAgain) {
  LidarScript script;
  script.close_after = 10;
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "closed"));
  EXPECT_TRUE(running.wait_for_scans(30));
  EXPECT_EQ(running.client().counters().reconnects, 1U);
  EXPECT_EQ(lidar.connections(), 2);
}

TEST(ScipClient, ASensorInTroubleSaysSoAndMayRecover) {
  LidarScript script;
  script.status_0m_after = 10;
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kTrouble, "0M"));
  EXPECT_TRUE(running.wait_for_scans(30));
  EXPECT_EQ(running.client().counters().reconnects, 0U);
}

TEST(ScipClient, NobodyThereIsToldAndTriedAgain) {
  std::string address;
  {
    const Listener listener;
    address = listener.address();
  }
  RunningClient running(hasty_options(address));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "connection refused"));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "next attempt in 0.4 s"))
      << "the back-off grows";
}

TEST(ScipClient, AServerThatNeverSpeaksIsNotWaitedForForEver) {
  const Listener mute;
  RunningClient running(hasty_options(mute.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "no answer to QT"));
}

TEST(ScipClient, OffSpecServersAreRefusedInWords) {
  LidarScript script;
  script.echo = "ME000010800100";
  expect_refusal(script, "'ME000010800100', which was not asked");
  script = {};
  script.acknowledges = false;
  expect_refusal(script, "without ME0000108001000 being acknowledged");
  script = {};
  script.stamp_characters = 3;
  expect_refusal(script, "3 characters instead of 4");
  script = {};
  script.beams_sent = 1080;
  expect_refusal(script, "1080 points");
  script = {};
  script.scan_status = "0M";
  expect_refusal(script, "0M: unstable");
  script = {};
  script.scan_status = "10";
  expect_refusal(script, "10: denied");
}

TEST(ScipClient, AServerThatDoesNotPaceItsScansIsRefused) {
  LidarScript script;
  script.paced = false;
  script.scan_period_ms = 25;
  const ScriptedLidar lidar(script);
  RunningClient running(hasty_options(lidar.address()));
  EXPECT_TRUE(running.wait_for_words(LidarState::kWaiting, "faster than the sensor"));
}

TEST(ScipClient, StopEndsEveryWaitSoon) {
  const Listener mute;
  ScipClientOptions options = hasty_options(mute.address());
  options.timeouts.quiet = milliseconds(60'000);
  RunningClient running(options);
  ASSERT_TRUE(running.wait_for_words(LidarState::kConnecting, "connecting"));
  const auto start = std::chrono::steady_clock::now();
  running.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

}  // namespace
}  // namespace swivel
