#include "hardware/lidar/scip_client.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "hardware/io/wait_ready.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

constexpr int kMostUnusableInARow = 3;
// Scans that come four times too fast over so many of them are no sensor's; a stalled computer
// or network may hand out a second's worth of scans at once.
constexpr int kPacedScans = 80;
constexpr double kFastestPace = 0.25;

DeviceClockOptions clock_options(const scip::Parameters& parameters, StampOrigin origin) {
  DeviceClockOptions options;
  options.nominal_scan_period_ns = parameters.scan_period_ns();
  options.stamp_origin = origin;
  options.turns_from_rear_to_first_beam =
      (180.0 - std::abs(parameters.first_beam_angle_deg())) / 360.0;
  options.turns_scanned = static_cast<double>(parameters.beams() - 1) / parameters.steps_per_turn;
  return options;
}

std::string in_words(const LidarIdentity& identity, const scip::Parameters& parameters) {
  char words[64];
  std::snprintf(words, sizeof(words), "%d beams, %.0f ms a turn", parameters.beams(),
                parameters.scan_period_ns() * 1e-6);
  return "scans come from " + identity.product + ", serial number " + identity.serial_number +
         ", firmware " + identity.firmware + ", " + words;
}

}  // namespace

struct ScipClient::Stream {
  std::string request;
  scip::Parameters parameters;
  std::string sensor;   // in words
  std::string trouble;  // in words, the last one reported
  DeviceClock clock;
  bool is_streaming = false;
  int unusable_in_a_row = 0;
  int scans_since_pace = 0;
  steady_clock::time_point pace_start;
  steady_clock::time_point last_good_scan;
};

ScipClient::ScipClient(ScipClientOptions options, OnScan on_scan, OnState on_state)
    : options_(std::move(options)),
      on_scan_(std::move(on_scan)),
      on_state_(std::move(on_state)),
      backoff_(options_.shortest_backoff) {}

void ScipClient::run() {
  while (!stopping_) {
    const std::string reason = serve_connection();
    if (!stopping_) wait_before_next_attempt(reason);
  }
  report(LidarState::kStopped, "stopped");
}

void ScipClient::stop() {
  stopping_ = true;
  wake_up_.notify();
}

std::optional<LidarIdentity> ScipClient::identity() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return identity_;
}

LidarCounters ScipClient::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

// Returns why the connection ended.
std::string ScipClient::serve_connection() {
  report(LidarState::kConnecting, "connecting to " + options_.address);
  Result<scip::Session> session =
      scip::Session::open(options_.address, options_.timeouts, &wake_up_, options_.tap);
  if (!session) return session.reason();
  Result<Stream> stream = prepare(*session);
  if (!stream) {
    session->leave();
    return stream.reason();
  }
  const Outcome started = session->start_scans(stream->request);
  std::string reason = started ? stream_scans(*session, *stream) : started.reason();
  session->leave();
  return reason;
}

Result<ScipClient::Stream> ScipClient::prepare(scip::Session& session) {
  const Result<LidarIdentity> identity = session.identify();
  if (!identity) return Failure{identity.reason()};
  const Result<scip::Parameters> parameters = session.read_parameters();
  if (!parameters) return Failure{parameters.reason()};
  const Result<scip::State> state = session.read_state();
  if (!state) return Failure{state.reason()};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    identity_ = *identity;
  }
  const auto measurement =
      options_.intensities ? scip::Measurement::kRangesAndIntensities : scip::Measurement::kRanges;
  Stream stream{scip::scan_request(measurement, parameters->first_step, parameters->last_step),
                *parameters,
                in_words(*identity, *parameters) + ", sensor says: " + state->status,
                {},
                DeviceClock(clock_options(*parameters, options_.stamp_origin)),
                false,
                0,
                0,
                {},
                {}};
  read_clock(session, stream.clock);
  return stream;
}

// Scans are good without it, only less exactly timed.
void ScipClient::read_clock(scip::Session& session, DeviceClock& clock) {
  const Result<std::vector<scip::ClockReading>> readings =
      session.read_clock(options_.clock_readings);
  if (!readings && stopping_) return;
  if (!readings) {
    report(
        LidarState::kConnecting,
        "times are taken from arrivals alone, since the clock was not read: " + readings.reason());
    return;
  }
  for (const scip::ClockReading& reading : *readings)
    clock.add_round_trip(reading.stamp_ms, reading.sent_ns, reading.received_ns);
}

std::string ScipClient::stream_scans(scip::Session& session, Stream& stream) {
  const auto watchdog =
      std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double, std::nano>(
          options_.watchdog_scan_periods * stream.parameters.scan_period_ns()));
  scip::ParserCounters counted = session.counters();
  stream.last_good_scan = stream.pace_start = steady_clock::now();
  for (;;) {
    const auto longest_wait = stream.is_streaming ? watchdog : options_.first_scan_timeout;
    const auto next = session.next_reply(stream.last_good_scan + longest_wait);
    count_damage(session, counted);
    if (!next) return next.reason();
    std::string reason = *next ? take(**next, stream) : std::string();
    if (!reason.empty()) return reason;
    if (steady_clock::now() - stream.last_good_scan >= longest_wait)
      return "no good scan for " + std::to_string(longest_wait.count()) +
             " ms: check the sensor's power and cable";
  }
}

// Returns why the connection must end, or nothing.
std::string ScipClient::take(const scip::TimedReply& incoming, Stream& stream) {
  const scip::Reply& reply = incoming.reply;
  if (reply.echo != stream.request)
    return unusable(stream, "a scan is headed '" + reply.echo.substr(0, 40) + "' instead of '" +
                                stream.request + "'");
  if (reply.status == "99") return take_scan(incoming, stream);
  stream.is_streaming = false;  // it may take its time to recover, as at the start
  const std::string trouble = scip::status_in_words(reply.echo, reply.status);
  if (trouble != std::exchange(stream.trouble, trouble)) report(LidarState::kTrouble, trouble);
  return {};
}

std::string ScipClient::take_scan(const scip::TimedReply& incoming, Stream& stream) {
  const auto measurement =
      options_.intensities ? scip::Measurement::kRangesAndIntensities : scip::Measurement::kRanges;
  Result<scip::Scan> scan =
      scip::decode_scan(incoming.reply, measurement, stream.parameters.beams());
  if (!scan) return unusable(stream, scan.reason());
  stream.unusable_in_a_row = 0;
  stream.last_good_scan = steady_clock::now();
  if (!stream.is_streaming) {
    stream.is_streaming = true;
    stream.trouble.clear();
    backoff_ = options_.shortest_backoff;
    report(LidarState::kStreaming, stream.sensor);
  }
  hand_out(std::move(*scan), incoming.arrival_time_ns, stream);
  if (++stream.scans_since_pace < kPacedScans) return {};
  const std::chrono::duration<double, std::nano> elapsed =
      steady_clock::now() - std::exchange(stream.pace_start, steady_clock::now());
  stream.scans_since_pace = 0;
  if (elapsed.count() < kFastestPace * kPacedScans * stream.parameters.scan_period_ns())
    return "scans come faster than the sensor says that it turns: this is no sensor";
  return {};
}

std::string ScipClient::unusable(Stream& stream, const std::string& reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counters_.unusable_replies;
  }
  return ++stream.unusable_in_a_row < kMostUnusableInARow ? std::string() : "refused: " + reason;
}

void ScipClient::hand_out(scip::Scan scan, std::int64_t arrival_time_ns, Stream& stream) {
  const LineTime time = stream.clock.add(scan.stamp_ms, arrival_time_ns);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counters_.scans;
    counters_.lost_scans += static_cast<std::uint64_t>(time.lines_lost);
    counters_.saturated_values += scan.saturated;
    counters_.clock_restarts += time.started_anew ? 1 : 0;
  }
  if (time.started_anew)
    report(LidarState::kStreaming, "line times start anew: " + stream.clock.last_restart_reason());
  LidarScan line;
  line.beam0_time_ns = time.beam0_time_ns;
  line.arrival_time_ns = arrival_time_ns;
  line.device_stamp_ms = scan.stamp_ms;
  line.first_beam_angle_deg = stream.parameters.first_beam_angle_deg();
  line.beam_step_deg = stream.parameters.beam_step_deg();
  line.scan_period_ns = stream.clock.scan_period_ns();
  line.beam_period_ns = line.scan_period_ns / stream.parameters.steps_per_turn;
  line.range_min_mm = stream.parameters.range_min_mm;
  line.range_max_mm = stream.parameters.range_max_mm;
  line.ranges_mm = std::move(scan.ranges_mm);
  line.intensities = std::move(scan.intensities);
  on_scan_(line);
}

void ScipClient::count_damage(const scip::Session& session, scip::ParserCounters& counted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.bad_sums += session.counters().bad_sums - counted.bad_sums;
  counters_.resyncs += session.counters().resyncs - counted.resyncs;
  counted = session.counters();
}

void ScipClient::report(LidarState state, const std::string& words) {
  on_state_({state, words, counters()});
}

void ScipClient::wait_before_next_attempt(const std::string& reason) {
  char seconds[32];
  std::snprintf(seconds, sizeof(seconds), "%.1f s", static_cast<double>(backoff_.count()) * 1e-3);
  report(LidarState::kWaiting, reason + "; next attempt in " + seconds);
  wait_ready(-1, 0, deadline_after(backoff_), &wake_up_);
  backoff_ = std::min(2 * backoff_, options_.longest_backoff);
  if (stopping_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.reconnects;
}

}  // namespace swivel
