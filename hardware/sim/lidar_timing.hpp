// When the lidar turns, fires, stamps and sends. It turns from power-up on, whether anybody
// listens or not: scan k begins at power-up + k periods.
#pragma once

#include <cstdint>

namespace swivel::sim {

struct LidarTimingOptions {
  double scan_period_ms = 25.04;      // the true one; 25 is nominal
  double clock_gain_ppm = 120.0;      // the sensor's millisecond counter runs fast by this
  double stamp_start_ms = 1.0e6;      // what the counter says at power-up
  bool stamp_at_rear_centre = false;  // else at the first beam; 3.125 ms apart
  double start_latency_ms = 80.0;     // from MD or ME to the first beam that is sent
  double send_delay_ms = 0.4;         // after the 1 ms tick that follows the last beam
  double send_jitter_ms = 0.4;        // and up to this more
};

class LidarTiming {
 public:
  // last_beam: of a scan, counted from 0 at the fan's first.
  LidarTiming(const LidarTimingOptions& options, std::int64_t power_up_ns, int steps_per_turn,
              int last_beam, std::uint64_t seed);

  double beam_period_ns() const { return period_ns_ / steps_per_turn_; }
  double scan_period_ns() const { return period_ns_; }

  // The first scan that begins at `time_ns` or later.
  std::uint64_t next_scan(std::int64_t time_ns) const;
  std::int64_t beam0_time_ns(std::uint64_t scan) const;
  std::int64_t send_time_ns(std::uint64_t scan) const;  // on the next tick after the last beam

  std::uint32_t stamp_ms(std::uint64_t scan) const;  // 24 bits
  std::uint32_t counter_ms(std::int64_t time_ns) const;
  void reset_counter(std::int64_t time_ns, double counter_ms = 0.0);  // to 0, as RS does

 private:
  double counter(double time_ns) const;

  LidarTimingOptions options_;
  std::int64_t power_up_ns_;
  double period_ns_;
  int steps_per_turn_;
  int last_beam_;
  std::uint64_t seed_;
  double counter_start_ms_;
  std::int64_t counter_since_ns_;
};

}  // namespace swivel::sim
