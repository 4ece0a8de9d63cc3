// attitude_corrector: raw clouds in, attitudes and corrected clouds out.
#include "components/attitude_corrector/corrector.hpp"
#include "components/attitude_corrector/sweep_and_cloud.hpp"
#include "components/common/cloud_message.hpp"
#include "components/common/health_reporter.hpp"
#include "components/common/program.hpp"
#include "components/log/log.hpp"

namespace {

using namespace swivel;

class CorrectionStage {
 public:
  CorrectionStage(Participant& participant, HealthReporter& health, const RigFile& rig)
      : corrector_(rig),
        attitudes_(participant, kAttitudeTopic),
        clouds_(participant, kCloudTopic),
        health_(health),
        rig_name_(participant.rig()) {}

  void set_calibration(const msg::Calibration& calibration) {
    const std::string wrong = corrector_.set_calibration(calibration);
    if (!wrong.empty()) return health_.error("a calibration was refused: " + wrong);
    log_info("calibration: alpha {:.4f} deg, from {}", calibration.alpha_deg(),
             calibration.provenance());
  }

  void take(const msg::Health& health) {
    const auto serial_number = lidar_serial_number(health);
    const std::string wrong = serial_number ? corrector_.name_lidar(*serial_number) : "";
    if (!wrong.empty()) health_.error("a calibration was refused: " + wrong);
  }

  void take(const msg::Sweep& sweep) {
    if (sweep.phase() == msg::PHASE_ASSEMBLED && pair_.add(sweep)) correct();
  }

  void take(const PointCloud2& cloud) {
    const std::string wrong = pair_.add(cloud);
    if (!wrong.empty()) health_.error("a raw cloud was refused: " + wrong);
    if (pair_.complete()) correct();
  }

  void report() {
    health_.set_counter("clouds_good", good_);
    health_.set_counter("clouds_uncorrected", uncorrected_);
    health_.set_counter("clouds_refused", pair_.clouds_refused());
    health_.set_counter("sweeps_without_cloud", pair_.sweeps_without_cloud());
    health_.set_state(msg::HEALTH_OK,
                      good_ + uncorrected_ == 0 ? "waiting for a raw cloud" : "correcting");
  }

 private:
  void correct() {
    msg::Attitude attitude = corrector_.correct(pair_.sweep(), pair_.cloud());
    const bool in_base = Corrector::in_base(attitude.verdict());
    ++(in_base ? good_ : uncorrected_);
    tell(attitude);
    if (!attitudes_.write(attitude)) health_.error("an Attitude could not be sent");
    to_message(pair_.cloud(), pair_.sweep().first_beam_time_ns(),
               in_base ? base_frame(rig_name_) : start_frame(rig_name_), message_);
    if (!clouds_.write(message_)) health_.error("a cloud could not be sent");
    pair_.clear();
  }

  void tell(const msg::Attitude& attitude) {
    if (Corrector::in_base(attitude.verdict())) {
      log_info("sweep {}: phi_offset {:.3f} +- {:.3f} deg, alpha {}", attitude.sweep_id(),
               attitude.phi_offset_deg(), attitude.phi_offset_sigma_deg(),
               attitude.calibrated() ? "calibrated" : "as drawn, not calibrated");
      if (!attitude.warning().empty()) health_.error(attitude.warning());
    } else {
      health_.error("sweep " + std::to_string(attitude.sweep_id()) +
                    " goes out uncorrected: " + attitude.reason());
    }
  }

  Corrector corrector_;
  SweepAndCloud pair_;
  Writer<msg::Attitude> attitudes_;
  Writer<PointCloud2> clouds_;
  HealthReporter& health_;
  std::string rig_name_;
  PointCloud2 message_;  // kept: a cloud's 11 MB are allocated once
  std::uint64_t good_ = 0;
  std::uint64_t uncorrected_ = 0;
};

void correct(const CommonOptions& options, StopSignal& stop) {
  const RigFile rig = load_rig_file(options.rig_file);
  Participant participant(options.participant("attitude_corrector", rig.rig));
  HealthReporter health(participant);
  CorrectionStage stage(participant, health, rig);

  participant.subscribe<msg::Calibration>(
      kCalibrationTopic, [&](const auto& calibration) { stage.set_calibration(calibration); });
  participant.subscribe<msg::Health>(kHealthTopic, [&](const auto& news) { stage.take(news); });
  participant.subscribe<msg::Sweep>(kSweepTopic, [&](const auto& sweep) { stage.take(sweep); });
  participant.subscribe<PointCloud2>(kRawCloudTopic, [&](const auto& cloud) { stage.take(cloud); });
  participant.on_tick(std::chrono::seconds(1), [&] { stage.report(); });
  participant.start();
  stop.wait();
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program("attitude_corrector",
                             "Corrects the attitude of raw clouds by the plate");
  return program.run(argc, argv, correct);
}
