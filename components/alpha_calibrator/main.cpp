// alpha_calibrator: on request asks for sweeps, finds the walls of the room in them and fits the
// plate's mounting angle alpha. The calibration is published, and kept for the next start.
#include <spdlog/spdlog.h>

#include <filesystem>

#include "components/alpha_calibrator/calibrator.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/health_reporter.hpp"
#include "components/common/program.hpp"
#include "components/common/strict_yaml.hpp"

namespace {

using namespace swivel;

// What was found is published and saved; what was saved is published at the start.
class CalibrationStore {
 public:
  CalibrationStore(Participant& participant, HealthReporter& health, std::string path)
      : writer_(participant, kCalibrationTopic), health_(health), path_(std::move(path)) {}

  void publish_saved(const std::string& rig) {
    if (!std::filesystem::exists(path_)) {
      spdlog::info("no calibration yet in {}: alpha is taken as drawn", path_);
      return;
    }
    msg::Calibration calibration = load_calibration(path_);
    if (calibration.rig().to_string() != rig) {
      throw ConfigurationError(path_ + ": is of rig '" + calibration.rig().to_string() +
                               "', not of '" + rig + "'");
    }
    writer_.write(calibration);
    spdlog::info("alpha {:.4f} deg, from {}", calibration.alpha_deg(), path_);
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
              spdlog::info("{} of {} sweeps: {}", step.sweeps_used(), step.sweeps_wanted(),
                           step.words());
              progress.write(msg::CalibrationProgress(step));
            },
            [&](const msg::Calibration& calibration) { store.publish(calibration); }});

  participant.subscribe<msg::Health>(kHealthTopic, [&](const auto& news) {
    if (news.participant().to_string() == "hokuyo_reader") calibrator.name_lidar(lidar_name(news));
  });
  const auto take = [&](const auto& message) { calibrator.take(message); };
  participant.subscribe<msg::CalibrationRequest>(kCalibrationRequestTopic, take);
  participant.subscribe<msg::Sweep>(kSweepTopic, take);
  participant.subscribe<msg::Attitude>(kAttitudeTopic, take);
  participant.subscribe<PointCloud2>(kRawCloudTopic, take);
  participant.on_tick(std::chrono::seconds(1), [&] {
    calibrator.check(std::chrono::steady_clock::now());
    health.set_state(msg::HEALTH_OK,
                     calibrator.running() ? "calibrating" : "waiting for a request");
  });
  participant.start();
  store.publish_saved(rig.rig);
  stop.wait();
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program(
      "alpha_calibrator", "Calibrates the plate's mounting angle alpha from the walls of a room");
  std::string calibration_path;
  program.add_option("--calibration", calibration_path, "Where the calibration is kept");
  return program.run(argc, argv, [&](const CommonOptions& options, StopSignal& stop) {
    calibrate(options, calibration_path, stop);
  });
}
