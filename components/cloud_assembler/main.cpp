// cloud_assembler: scan lines, axis angles and windows in, organised clouds out.
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/calibration_use.hpp"
#include "components/common/cloud_message.hpp"
#include "components/common/health_reporter.hpp"
#include "components/common/program.hpp"
#include "components/log/log.hpp"

namespace {

using namespace swivel;

AssemblyOptions assembly_options(const RigFile& rig) {
  return {rig.geometry, rig.axis_measured, rig.timing, rad_from_deg(rig.modes.sweep_angle_deg)};
}

// The Sweep goes out before the cloud: who has the cloud can know what it is.
class SweepPublisher {
 public:
  SweepPublisher(Participant& participant, HealthReporter& health, bool axis_measured)
      : sweeps_(participant, kSweepTopic),
        clouds_(participant, kRawCloudTopic),
        health_(health),
        frame_(axis_measured ? base_frame(participant.rig()) : start_frame(participant.rig())) {}

  void publish(AssembledSweep&& assembled) {
    const msg::Sweep& sweep = assembled.sweep;
    if (!sweep.complete()) {
      health_.error("sweep " + std::to_string(sweep.sweep_id()) + " incomplete: " + sweep.reason());
    }
    if (!sweeps_.write(assembled.sweep)) health_.error("a Sweep could not be sent");
    if (assembled.cloud.points.empty()) return;
    to_message(assembled.cloud, sweep.first_beam_time_ns(), frame_, message_);
    if (!clouds_.write(message_)) health_.error("a raw cloud could not be sent");
    log_info("sweep {}: mode {}, {} of {} lines", sweep.sweep_id(), sweep.mode(),
             sweep.lines_used(), sweep.lines_expected());
  }

  std::uint64_t clouds_written() const { return clouds_.written(); }

 private:
  Writer<msg::Sweep> sweeps_;
  Writer<PointCloud2> clouds_;
  HealthReporter& health_;
  std::string frame_;
  PointCloud2 message_;  // kept: a cloud's 11 MB are allocated once
};

// The mounting that the next sweep is assembled with.
class Mounting {
 public:
  Mounting(const RigFile& rig, Assembler& assembler, HealthReporter& health)
      : drawn_(rig.geometry), assembler_(assembler), health_(health), calibration_(rig.rig) {}

  void take(const msg::Calibration& calibration) { apply(calibration_.take(calibration)); }

  void take(const msg::Health& health) {
    if (const auto serial_number = lidar_serial_number(health)) {
      const bool used = calibration_.now().has_value();
      const std::string wrong = calibration_.name_lidar(*serial_number);
      if (used != calibration_.now().has_value()) apply(wrong);
    }
  }

 private:
  void apply(const std::string& wrong) {
    if (!wrong.empty()) health_.error("a calibration was refused: " + wrong);
    const auto& calibration = calibration_.now();
    const bool told = calibration && tells_mounting(*calibration);
    assembler_.set_geometry(told ? calibrated_geometry(drawn_, *calibration) : drawn_);
    health_.set_fact("mounting", told ? "calibrated" : "as drawn");
    log_info("mounting {}", told ? "from " + calibration->provenance() : "as drawn");
  }

  RigGeometry drawn_;
  Assembler& assembler_;
  HealthReporter& health_;
  CalibrationInUse calibration_;
};

void report(const Assembler& assembler, const SweepPublisher& publisher, HealthReporter& health) {
  const AssemblerCounters& counters = assembler.counters();
  health.set_counter("lines_received", counters.lines_received);
  health.set_counter("lines_used", counters.lines_used);
  health.set_counter("lines_outside", counters.lines_outside);
  health.set_counter("lines_rejected", counters.lines_rejected);
  health.set_counter("lines_late", counters.lines_late);
  health.set_counter("lines_missing", counters.lines_missing);
  health.set_counter("lines_waiting", assembler.lines_waiting());
  health.set_counter("windows_rejected", counters.windows_rejected);
  health.set_counter("axis_samples_rejected", counters.axis_samples_rejected);
  health.set_counter("sweeps_complete", counters.sweeps_complete);
  health.set_counter("sweeps_incomplete", counters.sweeps_incomplete);
  health.set_counter("sweeps_before_start", counters.sweeps_before_start);
  health.set_counter("clouds_written", publisher.clouds_written());
  health.set_state(counters.lines_received == 0 ? msg::HEALTH_WAITING : msg::HEALTH_OK,
                   counters.lines_received == 0 ? "waiting for scan lines" : "assembling");
}

void assemble(const CommonOptions& options, StopSignal& stop) {
  const RigFile rig = load_rig_file(options.rig_file);
  Participant participant(options.participant("cloud_assembler", rig.rig));
  HealthReporter health(participant);
  SweepPublisher publisher(participant, health, rig.axis_measured);
  Assembler assembler(assembly_options(rig),
                      [&](AssembledSweep&& assembled) { publisher.publish(std::move(assembled)); });

  Mounting mounting(rig, assembler, health);

  participant.subscribe<msg::Calibration>(kCalibrationTopic,
                                          [&](const auto& news) { mounting.take(news); });
  participant.subscribe<msg::Health>(kHealthTopic, [&](const auto& news) { mounting.take(news); });
  participant.subscribe<msg::ScanLine>(kScanLineTopic,
                                       [&](const auto& line) { assembler.add(line); });
  participant.subscribe<msg::Axis>(kAxisTopic, [&](const auto& axis) { assembler.add(axis); });
  participant.subscribe<msg::Sweep>(kSweepTopic, [&](const auto& sweep) { assembler.add(sweep); });
  participant.on_tick(std::chrono::milliseconds(200), [&] {
    assembler.check(std::chrono::steady_clock::now());
    report(assembler, publisher, health);
  });
  assembler.check(std::chrono::steady_clock::now());
  participant.start();
  stop.wait();
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program("cloud_assembler",
                             "Assembles scan lines and axis angles into organised clouds");
  return program.run(argc, argv, assemble);
}
