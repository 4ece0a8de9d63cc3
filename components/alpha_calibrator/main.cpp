// alpha_calibrator: on request asks for sweeps, and fits in them the plate's mounting angle alpha,
// from the walls of the room, or how the lidar stands on the axis. The calibration is published,
// and kept for the next start.
#include <filesystem>

#include "components/alpha_calibrator/calibrator.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/health_reporter.hpp"
#include "components/common/program.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/log/log.hpp"

namespace {

using namespace swivel;

// What was found is published and saved; what was saved is published at the start.
class CalibrationStore {
 public:
  CalibrationStore(Participant& participant, HealthReporter& health, std::string path)
      : writer_(participant, kCalibrationTopic), health_(health), path_(std::move(path)) {}

  // What was found before, if anything was. Before participant.start().
  void load(Calibrator& calibrator) {
    if (!std::filesystem::exists(path_)) {
      log_info("no calibration yet in {}: the rig is taken as drawn", path_);
      return;
    }
    saved_ = load_calibration(path_);
    const std::string wrong = calibrator.know(*saved_);
    if (!wrong.empty()) throw ConfigurationError(path_ + ": " + wrong);
    log_info("the calibration of {} is in use: {}", path_, saved_->provenance());
  }

  void publish_saved() {
    if (saved_) writer_.write(*saved_);
  }

  void publish(msg::Calibration calibration) {
    writer_.write(calibration);
    const std::string wrong = save_calibration(calibration, path_);
    if (!wrong.empty()) health_.error("the calibration is in use but not saved: " + wrong);
  }

 private:
  Writer<msg::Calibration> writer_;
  HealthReporter& health_;
  std::string path_;
  std::optional<msg::Calibration> saved_;
};

LidarName lidar_name(const msg::Health& health) {
  LidarName lidar;
  for (const msg::Fact& fact : health.facts()) {
    if (fact.name().to_string() == "serial_number") lidar.serial_number = fact.value();
    if (fact.name().to_string() == "firmware") lidar.firmware = fact.value();
  }
  return lidar;
}

void calibrate(const CommonOptions& options, const std::string& calibration_path,
               StopSignal& stop) {
  const RigFile rig = load_rig_file(options.rig_file);
  Participant participant(options.participant("alpha_calibrator", rig.rig));
  HealthReporter health(participant);
  CalibrationStore store(
      participant, health,
      calibration_path.empty() ? default_calibration_path(rig.rig) : calibration_path);
  Writer<msg::SweepRequest> requests(participant, kSweepRequestTopic);
  Writer<msg::CalibrationProgress> progress(participant, kCalibrationProgressTopic);
  Calibrator calibrator(
      rig, {[&](const msg::SweepRequest& request) { requests.write(msg::SweepRequest(request)); },
            [&](const msg::CalibrationProgress& step) {
              log_info("{} of {} sweeps: {}", step.sweeps_used(), step.sweeps_wanted(),
                       step.words());
              progress.write(msg::CalibrationProgress(step));
            },
            [&](const msg::Calibration& calibration) { store.publish(calibration); }});

  participant.subscribe<msg::Health>(kHealthTopic, [&](const auto& news) {
    if (news.participant().to_string() != "hokuyo_reader") return;
    const std::string wrong = calibrator.name_lidar(lidar_name(news));
    if (!wrong.empty()) health.error("the calibration is not used: " + wrong);
  });
  const auto take = [&](const auto& message) { calibrator.take(message); };
  participant.subscribe<msg::CalibrationRequest>(kCalibrationRequestTopic, take);
  participant.subscribe<msg::ScanLine>(kScanLineTopic, take);
  participant.subscribe<msg::Axis>(kAxisTopic, take);
  participant.subscribe<msg::Sweep>(kSweepTopic, take);
  participant.subscribe<msg::Attitude>(kAttitudeTopic, take);
  participant.subscribe<PointCloud2>(kRawCloudTopic, take);
  participant.on_tick(std::chrono::seconds(1), [&] {
    calibrator.check(std::chrono::steady_clock::now());
    health.set_counter("clouds_refused", calibrator.clouds_refused());
    health.set_state(msg::HEALTH_OK,
                     calibrator.running() ? "calibrating" : "waiting for a request");
  });
  store.load(calibrator);
  participant.start();
  store.publish_saved();
  stop.wait();
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program(
      "alpha_calibrator", "Calibrates the plate's angle alpha, or the lidar's mounting, in a room");
  std::string calibration_path;
  program.add_option("--calibration", calibration_path, "Where the calibration is kept");
  return program.run(argc, argv, [&](const CommonOptions& options, StopSignal& stop) {
    calibrate(options, calibration_path, stop);
  });
}
