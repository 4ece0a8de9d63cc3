// The sensor's clock, seen from the computer's: when was beam 0 of a line fired?
//
// The sensor stamps a line with whole milliseconds of a 24-bit counter, which run a little faster
// or slower than the computer's clock, and the line arrives later by a delay that is never less
// than what scanning and sending take. Hence
//   stamp(line)   = floor(origin + scan_period * line)          a least-squares line
//   arrival(line) = stamp + offset + gain * line + latency + (0 or more)      a lower envelope
// both over the last `window_lines`. Where the sensor answered TM before it streamed, the offset
// comes from its round trips and the latency is measured; otherwise the latency is assumed.
// No I/O: feed it live lines, or recorded ones.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "hardware/lidar/line_fit.hpp"

namespace swivel {

// What instant the stamp of a line names: sources disagree. A real UST-10LX (its arrival 24 ms
// after its stamp) and the sync output speak for the rear centre, 1/8 of a turn before beam 0;
// the manual of older models speaks for beam 0 itself. It matters when the offset comes from
// round trips; an offset from arrivals names the same instant either way.
enum class StampOrigin { kFirstBeam, kRearCentre };

struct DeviceClockOptions {
  double nominal_scan_period_ns = 25e6;
  StampOrigin stamp_origin = StampOrigin::kRearCentre;
  double turns_from_rear_to_first_beam = 0.125;
  double turns_scanned = 0.75;          // from the first beam to the last
  double transport_latency_ns = 0.5e6;  // assumed, from the last beam to the line's arrival
  std::size_t window_lines = 800;
  double slew_ppm = 50.0;  // once steady, corrections are no faster: a sweep sees no step
};

struct LineTime {
  std::int64_t beam0_time_ns = 0;  // smooth, and rising until the clock starts anew
  std::int64_t lines_lost = 0;     // between this line and the one before
  bool started_anew = false;       // see DeviceClock::last_restart_reason
};

struct ClockQuality {
  bool steady = false;  // some seconds of lines agree with the fit
  std::size_t lines_used = 0;
  double stamp_residual_ms = 0.0;  // rms; 0.29 is what whole milliseconds leave
  double gain_ppm = 0.0;           // the computer's clock against the sensor's, - 1
  bool offset_from_round_trips = false;
};

class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockOptions& options);

  // One answer to TM1, sent and received by the computer's clock. While the sensor is idle.
  void add_round_trip(std::uint32_t stamp_ms, std::int64_t sent_ns, std::int64_t received_ns);

  // Lines in the order of their arrival. Starts anew by itself when the stamps or the computer's
  // clock jump.
  LineTime add(std::uint32_t stamp_ms, std::int64_t arrival_ns);

  // For a jump that the caller knows of. What was learned of latency and period is kept.
  void restart(const std::string& reason);

  double scan_period_ns() const { return scan_period_ns_; }  // of the computer's clock
  const ClockQuality& quality() const { return quality_; }
  std::uint64_t restarts() const { return restarts_; }
  const std::string& last_restart_reason() const { return last_restart_reason_; }

 private:
  struct Line {
    double number = 0.0;
    double stamp_ns = 0.0;    // since the first stamp; the middle of its millisecond
    double arrival_ns = 0.0;  // since the first arrival
  };

  double stamp_ns_since_origin(std::uint32_t stamp_ms);
  double lines_since_last(std::uint32_t stamp_ms) const;
  std::string jump(std::uint32_t stamp_ms, std::int64_t arrival_ns) const;
  void append(std::uint32_t stamp_ms, std::int64_t arrival_ns);
  void drop_unlikely_round_trips();
  void fit_stamps();
  void fit_arrivals();
  double offset_ns() const;
  double target_ns() const;
  bool place(double lines_passed);

  DeviceClockOptions options_;
  double expected_period_ns_ = 0.0;  // of the sensor's clock: nominal, or learned before a restart
  // All times below count from these two instants, to be small enough for a double.
  std::optional<std::int64_t> computer_origin_ns_;
  std::optional<std::uint32_t> last_stamp_ms_;
  double last_stamp_since_origin_ms_ = 0.0;

  std::deque<Line> window_;
  FittedLine stamp_of_line_;       // ns over lines, the newest line being 0
  FittedLine delay_of_line_;       // arrival - stamp, ns: the lower envelope
  double lowest_offset_ns_ = 0.0;  // round trips: computer - sensor lies between these two
  double highest_offset_ns_ = 0.0;
  bool has_round_trips_ = false;
  std::optional<double> measured_latency_ns_;

  double placed_ns_ = 0.0;  // the newest line's stamp instant
  double scan_period_ns_ = 0.0;
  ClockQuality quality_;
  std::uint64_t restarts_ = 0;
  std::string last_restart_reason_;
};

}  // namespace swivel
