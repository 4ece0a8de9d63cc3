// swivel calibrate alpha RECORDING -o DIR: the plate's true azimuth, from a recording's sweeps.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/alpha_calibrator/alpha_calibration.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline_pipeline.hpp"
#include "components/swivel/text_file.hpp"
#include "components/swivel/verbs.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

struct CalibrateOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;
  std::optional<double> room_yaw_deg;
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
  AlphaCalibration alpha(rig, options.room_yaw_deg.value_or(recorded_yaw_deg));
  make_folder(options.folder);

  run_offline(std::move(recording), rig, std::nullopt, [&](const ProcessedSweep& processed) {
    const auto added = alpha.add(processed.attitude, processed.raw);
    std::cout << "sweep " << processed.index << ": " << added.words << std::endl;
  });
  const msg::Calibration calibration = fit(alpha, options.recording);
  const std::string path = options.folder + "/calibration.yaml";
  if (const std::string reason = save_calibration(calibration, path); !reason.empty())
    throw ExitError(kExitInputOutput, reason);
  std::cout << "written to " << path << std::endl;
  return kExitOk;
}

}  // namespace

void add_calibrate(CLI::App& app, Verb& chosen) {
  CLI::App* const calibrate =
      app.add_subcommand("calibrate", "Finds what the drawing does not say");
  calibrate->require_subcommand(1);
  CLI::App* const verb =
      calibrate->add_subcommand("alpha", "The plate's azimuth, from the walls of a square room");
  const auto options = std::make_shared<CalibrateOptions>();
  verb->add_option("recording", options->recording, "A case folder of the plate rig")->required();
  verb->add_option("-o,--output", options->folder, "The folder for calibration.yaml")->required();
  verb->add_option("--rig", options->rig_file, "The rig file [that which suits the recording]");
  verb->add_option("--room-yaw-deg", options->room_yaw_deg,
                   "Azimuth of the room's front as the rig stands [as recorded, or 0]");
  verb->callback([options, &chosen] { chosen = [options] { return calibrate_alpha(*options); }; });
}

}  // namespace swivel
