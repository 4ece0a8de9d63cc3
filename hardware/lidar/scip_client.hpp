// A sensor that streams for as long as the program runs: connects, identifies, reads the clock,
// measures; and starts over, in words, when anything goes wrong.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hardware/io/wake_up.hpp"
#include "hardware/lidar/device_clock.hpp"
#include "hardware/lidar/scip_session.hpp"

namespace swivel {

// One turn. Beam k was fired at beam0_time_ns + k * beam_period_ns, at
// first_beam_angle_deg + k * beam_step_deg: counter-clockwise seen from above, 0 straight ahead.
struct LidarScan {
  std::int64_t beam0_time_ns = 0;
  std::int64_t arrival_time_ns = 0;
  std::uint32_t device_stamp_ms = 0;
  double first_beam_angle_deg = 0.0;
  double beam_step_deg = 0.0;
  double beam_period_ns = 0.0;
  double scan_period_ns = 0.0;
  std::uint16_t range_min_mm = 0;
  std::uint16_t range_max_mm = 0;
  std::vector<std::uint16_t> ranges_mm;    // with the sensor's codes: see beam_status
  std::vector<std::uint16_t> intensities;  // empty unless asked for
};

struct LidarCounters {
  std::uint64_t scans = 0;       // handed out
  std::uint64_t lost_scans = 0;  // gaps in the stamps, damaged scans included
  std::uint64_t bad_sums = 0;
  std::uint64_t resyncs = 0;           // bad sums included
  std::uint64_t unusable_replies = 0;  // whole, but not what was asked for
  std::uint64_t saturated_values = 0;  // beyond 65535
  std::uint64_t clock_restarts = 0;
  std::uint64_t reconnects = 0;
};

enum class LidarState {
  kConnecting,  // up to the first scan
  kStreaming,
  kTrouble,  // connected, but the sensor says that something is wrong
  kWaiting,  // before the next attempt
  kStopped
};

struct LidarReport {
  LidarState state = LidarState::kConnecting;
  std::string words;
  LidarCounters counters;
};

struct ScipClientOptions {
  std::string address = "tcp://192.168.0.10:10940";  // as ByteStream::open takes it
  bool intensities = true;
  StampOrigin stamp_origin = StampOrigin::kRearCentre;
  scip::SessionTimeouts timeouts;
  std::chrono::milliseconds first_scan_timeout{5000};
  double watchdog_scan_periods = 20.0;  // the longest wait for a good scan
  std::chrono::milliseconds shortest_backoff{500};
  std::chrono::milliseconds longest_backoff{1000};  // so that it is soon back once it can be
  int clock_readings = 20;
  WireTap tap;  // of every connection
};

class ScipClient {
 public:
  // Both are called on the thread of run().
  using OnScan = std::function<void(const LidarScan&)>;
  using OnState = std::function<void(const LidarReport&)>;

  ScipClient(ScipClientOptions options, OnScan on_scan, OnState on_state);

  // Returns after stop(), and leaves the sensor quiet. Once.
  void run();
  void stop();  // from any thread, or a signal handler; also before run()

  std::optional<LidarIdentity> identity() const;  // of the last sensor connected to
  LidarCounters counters() const;

 private:
  struct Stream;  // what is known of the connection that scans come from

  std::string serve_connection();
  Result<Stream> prepare(scip::Session& session);
  void read_clock(scip::Session& session, DeviceClock& clock);
  std::string stream_scans(scip::Session& session, Stream& stream);
  std::string take(const scip::TimedReply& incoming, Stream& stream);
  std::string take_scan(const scip::TimedReply& incoming, Stream& stream);
  std::string unusable(Stream& stream, const std::string& reason);
  void hand_out(scip::Scan scan, std::int64_t arrival_time_ns, Stream& stream);
  void count_damage(const scip::Session& session, scip::ParserCounters& counted);
  void report(LidarState state, const std::string& words);
  void wait_before_next_attempt(const std::string& reason);

  const ScipClientOptions options_;
  const OnScan on_scan_;
  const OnState on_state_;
  std::atomic<bool> stopping_{false};
  WakeUp wake_up_;
  std::chrono::milliseconds backoff_;

  mutable std::mutex mutex_;  // of what follows
  std::optional<LidarIdentity> identity_;
  LidarCounters counters_;
};

}  // namespace swivel
