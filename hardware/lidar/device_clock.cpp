#include "hardware/lidar/device_clock.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hardware/lidar/scip.hpp"

namespace swivel {
namespace {

constexpr double kMillisecondNs = 1e6;

constexpr double kStampErrorNs = 0.29e6;    // of whole milliseconds
constexpr double kMotorTolerance = 0.0015;  // of the speed that PP says: real ones are 0.0016 off
constexpr double kEnvelopeErrorNs = 0.1e6;
constexpr double kQuartzTolerance = 50e-6;  // of the sensor's clock against the computer's

constexpr double kDelayBlockLines = 40.0;
constexpr double kDelayToleranceNs = 0.5e6;

constexpr std::size_t kSteadyLines = 160;
constexpr double kSteadyResidualMs = 1.0;

constexpr double kLongestGapMs = 4000.0;  // beyond, lines cannot be counted by the period
constexpr double kSmallestJumpNs = 5e6;
constexpr double kLatestArrivalNs = 2e9;

SlopePrior prior(double slope_ns, double tolerance, double period_ns, double error_ns) {
  const double sigma_ns = tolerance * period_ns;
  return {slope_ns, (error_ns * error_ns) / (sigma_ns * sigma_ns)};
}

}  // namespace

DeviceClock::DeviceClock(const DeviceClockOptions& options)
    : options_(options),
      expected_period_ns_(options.nominal_scan_period_ns),
      scan_period_ns_(options.nominal_scan_period_ns) {
  assert(options.nominal_scan_period_ns > 0.0 && options.window_lines >= kSteadyLines);
  stamp_of_line_.slope = scan_period_ns_;
}

// The sensor read its clock between sending and receiving, within the millisecond of the stamp:
// every round trip leaves an interval for the offset, and all of them their intersection.
void DeviceClock::add_round_trip(std::uint32_t stamp_ms, std::int64_t sent_ns,
                                 std::int64_t received_ns) {
  assert(window_.empty() && sent_ns <= received_ns);
  if (!computer_origin_ns_) computer_origin_ns_ = sent_ns;
  const double stamp_ns = stamp_ns_since_origin(stamp_ms);
  const double lowest =
      static_cast<double>(sent_ns - *computer_origin_ns_) - stamp_ns - kMillisecondNs / 2;
  const double highest =
      static_cast<double>(received_ns - *computer_origin_ns_) - stamp_ns + kMillisecondNs / 2;
  const bool agrees =
      has_round_trips_ && lowest <= highest_offset_ns_ && highest >= lowest_offset_ns_;
  lowest_offset_ns_ = agrees ? std::max(lowest, lowest_offset_ns_) : lowest;
  highest_offset_ns_ = agrees ? std::min(highest, highest_offset_ns_) : highest;
  has_round_trips_ = true;
}

LineTime DeviceClock::add(std::uint32_t stamp_ms, std::int64_t arrival_ns) {
  const std::uint64_t restarts_before = restarts_;
  const std::string reason = window_.empty() ? std::string() : jump(stamp_ms, arrival_ns);
  if (!reason.empty()) restart(reason);
  const double lines_passed = window_.empty() ? 0.0 : lines_since_last(stamp_ms);
  append(stamp_ms, arrival_ns);
  if (!place(lines_passed)) {
    restart("line times drifted by more than 5 ms: the computer's clock was stepped");
    append(stamp_ms, arrival_ns);
    place(0.0);
  }
  LineTime time;
  time.started_anew = restarts_ != restarts_before;
  time.lines_lost =
      time.started_anew ? 0 : std::max<std::int64_t>(0, std::llround(lines_passed) - 1);
  const double to_first_beam_turns = options_.stamp_origin == StampOrigin::kRearCentre
                                         ? options_.turns_from_rear_to_first_beam
                                         : 0;
  time.beam0_time_ns =
      *computer_origin_ns_ + std::llround(placed_ns_ + to_first_beam_turns * scan_period_ns_);
  return time;
}

void DeviceClock::restart(const std::string& reason) {
  ++restarts_;
  last_restart_reason_ = reason;
  computer_origin_ns_.reset();
  last_stamp_ms_.reset();
  window_.clear();
  // The motor is still the same one.
  expected_period_ns_ = std::clamp(stamp_of_line_.slope, 0.99 * options_.nominal_scan_period_ns,
                                   1.01 * options_.nominal_scan_period_ns);
  stamp_of_line_ = {0.0, expected_period_ns_};
  delay_of_line_ = {};
  has_round_trips_ = false;
  quality_ = {};
}

// Unwraps the 24 bits.
double DeviceClock::stamp_ns_since_origin(std::uint32_t stamp_ms) {
  last_stamp_since_origin_ms_ =
      last_stamp_ms_
          ? last_stamp_since_origin_ms_ + ((stamp_ms - *last_stamp_ms_) & scip::kStampMask)
          : 0.0;
  last_stamp_ms_ = stamp_ms;
  return (last_stamp_since_origin_ms_ + 0.5) * kMillisecondNs;
}

double DeviceClock::lines_since_last(std::uint32_t stamp_ms) const {
  const double step_ns = ((stamp_ms - *last_stamp_ms_) & scip::kStampMask) * kMillisecondNs;
  return std::round(step_ns / stamp_of_line_.slope);
}

// Empty when the line goes on from those before it.
std::string DeviceClock::jump(std::uint32_t stamp_ms, std::int64_t arrival_ns) const {
  const double step_ms = (stamp_ms - *last_stamp_ms_) & scip::kStampMask;
  if (step_ms > kLongestGapMs)
    return "the sensor's clock jumped: it was restarted, or was silent for seconds";
  const double lines = lines_since_last(stamp_ms);
  const double misfit_ns = step_ms * kMillisecondNs - lines * stamp_of_line_.slope;
  if (lines < 1.0 || std::abs(misfit_ns) > stamp_of_line_.slope / 4)
    return "the sensor's stamps do not follow its scan period: its clock was set";
  const double expected_ns =
      stamp_of_line_.at_zero + delay_of_line_.at_zero + lines * scan_period_ns_;
  const double late_ns = static_cast<double>(arrival_ns - *computer_origin_ns_) - expected_ns;
  if (late_ns > kLatestArrivalNs)
    return "a line came seconds late: the computer's clock was set forward";
  return {};
}

void DeviceClock::append(std::uint32_t stamp_ms, std::int64_t arrival_ns) {
  const double number = window_.empty() ? 0.0 : window_.back().number + lines_since_last(stamp_ms);
  if (!computer_origin_ns_) computer_origin_ns_ = arrival_ns;
  window_.push_back({number, stamp_ns_since_origin(stamp_ms),
                     static_cast<double>(arrival_ns - *computer_origin_ns_)});
  if (window_.size() > options_.window_lines) window_.pop_front();
  if (window_.size() == 1) drop_unlikely_round_trips();
  fit_stamps();
  fit_arrivals();
}

// A line arrives after its stamp, and not seconds after it; else the sensor's TM counts something
// else than its scans do.
void DeviceClock::drop_unlikely_round_trips() {
  const Line& line = window_.front();
  const double latency_ns = line.arrival_ns - line.stamp_ns - lowest_offset_ns_;
  if (latency_ns < 0.0 || latency_ns > kLatestArrivalNs) has_round_trips_ = false;
}

void DeviceClock::fit_stamps() {
  std::vector<LinePoint> points;
  points.reserve(window_.size());
  const double newest = window_.back().number;
  for (const Line& line : window_) points.push_back({line.number - newest, line.stamp_ns});
  stamp_of_line_ = fit_line(
      points, prior(expected_period_ns_, kMotorTolerance, expected_period_ns_, kStampErrorNs));
  double squares = 0.0;
  for (const LinePoint& point : points)
    squares += std::pow((point.y - stamp_of_line_.at(point.x)) / kMillisecondNs, 2);
  quality_.lines_used = points.size();
  quality_.stamp_residual_ms = std::sqrt(squares / static_cast<double>(points.size()));
}

void DeviceClock::fit_arrivals() {
  std::vector<LinePoint> delays;
  delays.reserve(window_.size());
  const double newest = window_.back().number;
  for (auto line = window_.rbegin(); line != window_.rend(); ++line) {
    const double x = line->number - newest;
    delays.push_back({x, line->arrival_ns - stamp_of_line_.at(x)});
  }
  delay_of_line_ = fit_lower_envelope(
      delays, kDelayBlockLines, kDelayToleranceNs,
      prior(0.0, kQuartzTolerance, options_.nominal_scan_period_ns, kEnvelopeErrorNs));
  quality_.gain_ppm = delay_of_line_.slope / stamp_of_line_.slope * 1e6;
  scan_period_ns_ = stamp_of_line_.slope + delay_of_line_.slope;
}

// Of the newest line: add it to an instant of the sensor's clock.
double DeviceClock::offset_ns() const {
  if (measured_latency_ns_) return delay_of_line_.at_zero - *measured_latency_ns_;
  if (has_round_trips_) return (lowest_offset_ns_ + highest_offset_ns_) / 2;
  const double turns = options_.turns_scanned + (options_.stamp_origin == StampOrigin::kRearCentre
                                                     ? options_.turns_from_rear_to_first_beam
                                                     : 0.0);
  return delay_of_line_.at_zero - turns * scan_period_ns_ - options_.transport_latency_ns;
}

double DeviceClock::target_ns() const {
  return stamp_of_line_.at_zero + offset_ns();
}

// Moves on to the newest line; false when it lies so far off that it must not be slewed to.
bool DeviceClock::place(double lines_passed) {
  const bool is_steady =
      window_.size() >= kSteadyLines && quality_.stamp_residual_ms < kSteadyResidualMs;
  if (is_steady && has_round_trips_ && !measured_latency_ns_)
    measured_latency_ns_ = delay_of_line_.at(window_.front().number - window_.back().number) -
                           (lowest_offset_ns_ + highest_offset_ns_) / 2;
  const double expected_ns = placed_ns_ + lines_passed * scan_period_ns_;
  const double correction_ns = target_ns() - expected_ns;
  if (quality_.steady && std::abs(correction_ns) > kSmallestJumpNs) return false;
  const double slew = quality_.steady ? options_.slew_ppm * 1e-6 : 0.5;
  const double limit_ns = slew * lines_passed * scan_period_ns_;
  placed_ns_ = lines_passed == 0.0 ? target_ns()
                                   : expected_ns + std::clamp(correction_ns, -limit_ns, limit_ns);
  quality_.steady = is_steady;
  quality_.offset_from_round_trips = has_round_trips_;
  return true;
}

}  // namespace swivel
