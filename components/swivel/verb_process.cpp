// swivel process RECORDING -o DIR: clouds, pictures and numbers from a recording.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>

#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/offline/output_folder.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ProcessOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;
  std::string calibration_file;
  OutputKinds kinds;
};

std::string title_of(const std::string& recording) {
  return std::filesystem::path(recording).lexically_normal().filename();
}

int process(const ProcessOptions& options) {
  Recording recording = open_recording(options.recording);
  const RecordingFacts facts = recording.facts();
  const RigFile rig = rig_of(facts, options.recording, options.rig_file);
  std::optional<msg::Calibration> calibration;
  if (!options.calibration_file.empty()) calibration = load_calibration(options.calibration_file);

  OutputFolder output(options.folder, title_of(options.recording), rig, options.kinds);
  output.note("recording", options.recording);
  output.note("calibration_file", options.calibration_file);
  output.note("scan_period_ms", facts.scan_period_ns * 1e-6);
  run_offline(std::move(recording), rig, calibration,
              [&](const ProcessedSweep& processed) { output.add(processed); });
  output.finish();
  return output.sweeps() == facts.modes.size() ? kExitOk : kExitInternal;
}

}  // namespace

void add_process(CLI::App& app, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand(
      "process", "Turns a recording into clouds, pictures and numbers, without DDS");
  const auto options = std::make_shared<ProcessOptions>();
  verb->add_option("recording", options->recording, "A .csv.gz recording, or a case folder")
      ->required();
  verb->add_option("-o,--output", options->folder, "The folder to write to")->required();
  verb->add_option("--rig", options->rig_file, "The rig file [that which suits the recording]");
  verb->add_option("--calibration", options->calibration_file,
                   "A calibration.yaml [alpha as drawn]");
  verb->add_flag("--no-clouds", options->kinds.no_clouds, "Write no PCD and PLY");
  verb->add_flag("--no-pictures", options->kinds.no_pictures, "Write no PNG");
  verb->callback([options, &chosen] { chosen = [options] { return process(*options); }; });
}

}  // namespace swivel
