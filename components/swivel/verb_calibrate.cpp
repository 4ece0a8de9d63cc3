// swivel calibrate alpha: the plate's true azimuth, by a live rig or from a recording's sweeps.
// swivel calibrate mounting: how the lidar stands on the axis, likewise.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/alpha_calibrator/alpha_calibration.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/common/roll.hpp"
#include "components/swivel/live/calibrate_live.hpp"
#include "components/swivel/live/participants.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/offline/recorded_mounting.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/source_options.hpp"
#include "components/swivel/verbs.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

struct CalibrateOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;
  std::optional<double> room_yaw_deg;
  std::optional<double> sigma_deg;                        // recorded
  std::size_t least_sweeps = AlphaWishes().least_sweeps;  // recorded
  int mode = 7;                                           // live
  int count = 5;
};

msg::Calibration fit(const AlphaCalibration& alpha, const std::string& recording) {
  const AlphaCalibration::Outcome outcome = alpha.fit({}, now_ns());
  if (!outcome.calibration) throw ExitError(kExitBadData, recording + ": " + outcome.words);
  std::cout << outcome.words << std::endl;
  msg::Calibration calibration = *outcome.calibration;
  calibration.provenance(calibration.provenance() + "; from the recording " + recording);
  return calibration;
}

int calibrate_alpha(const CalibrateOptions& options) {
  Recording recording = open_recording(options.recording);
  const RecordingFacts facts = recording.facts();
  const RigFile rig = rig_of(facts, options.recording, options.rig_file);
  const double recorded_yaw_deg = facts.plate ? facts.plate->room_yaw_deg : 0.0;
  AlphaCalibration alpha(rig, {options.room_yaw_deg.value_or(recorded_yaw_deg),
                               options.least_sweeps, options.sigma_deg});
  make_folder(options.folder);

  run_offline_as_drawn(recording, rig, [&](const ProcessedSweep& processed) {
    const std::string name = std::to_string(processed.index);
    const auto added = alpha.add(processed.attitude, processed.raw, name);
    std::cout << "sweep " << name << ": " << (added.used ? "" : "left out: ") << added.words
              << std::endl;
  });
  const msg::Calibration calibration = fit(alpha, options.recording);
  const std::string path = options.folder + "/calibration.yaml";
  if (const std::string reason = save_calibration(calibration, path); !reason.empty())
    throw ExitError(kExitInputOutput, reason);
  std::cout << "written to " << path << std::endl;
  return kExitOk;
}

int calibrate_live(const CommonOptions& common, const msg::CalibrationRequest& request,
                   StopSignal& stop) {
  start_log("swivel", "warning");
  const RigFile rig = load_rig_file(common.rig_file);
  Participant participant(common.participant("swivel_calibrate", rig.rig));
  const Roll roll(participant);
  LiveCalibration calibration(participant);
  participant.start();
  const std::string missing = roll.await(participants_of("all"), std::chrono::seconds(30));
  if (!missing.empty()) throw ExitError(kExitUnavailable, missing + "; start them with: swivel up");
  calibration.run(request, stop);
  return kExitOk;
}

void add_live_options(CLI::App& verb, CalibrateOptions& options) {
  verb.add_option("--mode", options.mode, "Live: of the sweeps")->capture_default_str();
  verb.add_option("--count", options.count, "Live: how many sweeps")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

void add_calibrate_mounting(CLI::App& calibrate, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb = calibrate.add_subcommand(
      "mounting", "How the lidar stands on the axis, and the bias of its centreline");
  const auto common = std::make_shared<CommonOptions>();
  const auto live = std::make_shared<CalibrateOptions>();
  const auto recorded = std::make_shared<RecordedMountingOptions>();
  live->mode = 2;
  live->count = 2;
  auto* const recording =
      verb->add_option("recording", recorded->recording,
                       "An .mcap or .csv.gz recording, or a case folder; else live");
  recording->needs(
      verb->add_option("-o,--output", recorded->folder,
                       "The folder for mounting.json and calibration.yaml, of a recording"));
  verb->add_flag("--per-sweep", recorded->per_sweep, "Recorded: each sweep alone")
      ->needs(recording);
  add_live_options(*verb, *live);
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    recorded->rig_file = asked_rig_file(*verb, *common);
    chosen = [=, &stop]() -> int {
      if (recorded->recording.empty()) {
        return calibrate_live(
            *common, calibration_request(msg::CALIBRATION_OF_MOUNTING, live->mode, live->count),
            stop);
      }
      calibrate_recorded_mounting(*recorded);
      return kExitOk;
    };
  });
}

}  // namespace

void add_calibrate(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const calibrate =
      app.add_subcommand("calibrate", "Finds what the drawing does not say");
  calibrate->require_subcommand(1);
  CLI::App* const verb =
      calibrate->add_subcommand("alpha", "The plate's azimuth, from the walls of a room");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<CalibrateOptions>();
  auto* const recording =
      verb->add_option("recording", options->recording,
                       "Of the plate rig: .mcap or a case folder; without it, live");
  recording->needs(
      verb->add_option("-o,--output", options->folder,
                       "The folder for calibration.yaml; live, alpha_calibrator has it"));
  add_live_options(*verb, *options);
  verb->add_option("--room-yaw-deg", options->room_yaw_deg,
                   "Azimuth of the room's front as the rig stands [as recorded, or 0]");
  verb->add_option("--sigma-deg", options->sigma_deg,
                   "Says how many more sweeps bring alpha to this sigma")
      ->check(CLI::PositiveNumber)
      ->needs(recording);
  verb->add_option("--least-sweeps", options->least_sweeps,
                   "Fewer are refused; a single one has nothing to check it")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->needs(recording);
  add_common_options(*verb, *common);
  add_calibrate_mounting(*calibrate, stop, chosen);
  verb->callback([=, &stop, &chosen] {
    options->rig_file = asked_rig_file(*verb, *common);
    chosen = [=, &stop] {
      if (!options->recording.empty()) return calibrate_alpha(*options);
      auto request = calibration_request(msg::CALIBRATION_OF_ALPHA, options->mode, options->count);
      request.room_yaw_deg(options->room_yaw_deg.value_or(0.0));
      return calibrate_live(*common, request, stop);
    };
  });
}

}  // namespace swivel
