// hokuyo_reader: a Hokuyo lidar on TCP or a serial device in, scan lines out. It streams at all
// times and knows nothing of sweeps.
#include <thread>

#include "components/common/health_reporter.hpp"
#include "components/common/heartbeat.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/common/wire_publisher.hpp"
#include "components/log/log.hpp"
#include "hardware/lidar/scip_client.hpp"

namespace {

using namespace swivel;

// The session waits 10 s before another attempt, and then for each answer in turn.
constexpr auto kLongestSilence = std::chrono::seconds(60);

msg::ScanLine to_message(const LidarScan& scan) {
  msg::ScanLine line;
  line.beam0_time_ns(scan.beam0_time_ns);
  line.arrival_time_ns(scan.arrival_time_ns);
  line.device_stamp_ms(scan.device_stamp_ms);
  line.first_beam_angle_deg(scan.first_beam_angle_deg);
  line.beam_step_deg(scan.beam_step_deg);
  line.beam_period_ns(scan.beam_period_ns);
  line.scan_period_ns(scan.scan_period_ns);
  line.range_min_mm(scan.range_min_mm);
  line.range_max_mm(scan.range_max_mm);
  line.ranges_mm(scan.ranges_mm);
  line.intensities(scan.intensities);
  return line;
}

ScipClientOptions client_options(const LidarSection& lidar, WireTap tap) {
  ScipClientOptions options;
  options.address = lidar.address;
  options.intensities = lidar.intensities;
  options.stamp_origin =
      lidar.stamp_at_rear_centre ? StampOrigin::kRearCentre : StampOrigin::kFirstBeam;
  options.tap = std::move(tap);
  return options;
}

msg::HealthState health_state(LidarState state) {
  switch (state) {
    case LidarState::kStreaming:
      return msg::HEALTH_OK;
    case LidarState::kTrouble:
      return msg::HEALTH_DEGRADED;
    case LidarState::kConnecting:
    case LidarState::kWaiting:
      return msg::HEALTH_WAITING;
    case LidarState::kStopped:
      return msg::HEALTH_STOPPED;
  }
  return msg::HEALTH_FAULT;
}

void tell(const LidarReport& report, HealthReporter& health) {
  if (report.state == LidarState::kWaiting || report.state == LidarState::kTrouble) {
    health.error(report.words);
  } else {
    log_info("{}", report.words);
  }
  health.set_state(health_state(report.state), report.words);
}

void count(const LidarCounters& counters, const Writer<msg::ScanLine>& lines,
           HealthReporter& health) {
  health.set_counter("lines_written", lines.written());
  health.set_counter("lines_not_written", lines.failures());
  health.set_counter("scans", counters.scans);
  health.set_counter("scans_lost", counters.lost_scans);
  health.set_counter("bad_sums", counters.bad_sums);
  health.set_counter("resyncs", counters.resyncs);
  health.set_counter("unusable_replies", counters.unusable_replies);
  health.set_counter("saturated_values", counters.saturated_values);
  health.set_counter("clock_restarts", counters.clock_restarts);
  health.set_counter("reconnects", counters.reconnects);
}

void name_lidar(const std::optional<LidarIdentity>& lidar, HealthReporter& health) {
  if (!lidar) return;
  health.set_fact("model", lidar->product);
  health.set_fact("serial_number", lidar->serial_number);
  health.set_fact("firmware", lidar->firmware);
}

LidarSection lidar_of(const RigFile& rig, const std::string& address) {
  if (!rig.lidar) throw ConfigurationError(rig.path + ": has no 'lidar' section to read from");
  LidarSection lidar = *rig.lidar;
  if (!address.empty()) lidar.address = address;
  return lidar;
}

void read(const CommonOptions& options, const std::string& address, StopSignal& stop) {
  const RigFile rig = load_rig_file(options.rig_file);
  const LidarSection lidar = lidar_of(rig, address);
  Participant participant(options.participant("hokuyo_reader", rig.rig));
  HealthReporter health(participant);
  Writer<msg::ScanLine> lines(participant, kScanLineTopic);
  WirePublisher wire(participant, msg::WIRE_OF_LIDAR);
  Heartbeat session_works;  // it says a scan, or how it stands
  health.watch_over([&] { return session_works.was_within(kLongestSilence); });
  ScipClient client(
      client_options(lidar, wire.tap()),
      [&](const LidarScan& scan) {
        session_works.beat();
        lines.write(to_message(scan));
      },
      [&](const LidarReport& report) {
        session_works.beat();
        tell(report, health);
      });
  participant.on_tick(std::chrono::milliseconds(500), [&] {
    count(client.counters(), lines, health);
    name_lidar(client.identity(), health);
    health.set_counter("wire_messages_not_sent", wire.not_sent());
  });
  participant.start();
  std::thread session([&] { client.run(); });
  stop.wait();
  client.stop();
  session.join();
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program("hokuyo_reader", "Reads a Hokuyo lidar and publishes its scan lines");
  std::string address;
  program.add_option("--lidar", address, "tcp://HOST:PORT or /dev/NAME, instead of the rig file's");
  return program.run(argc, argv, [&](const CommonOptions& options, StopSignal& stop) {
    read(options, address, stop);
  });
}
