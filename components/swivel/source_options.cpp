#include "components/swivel/source_options.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace swivel {

void add_source_options(CLI::App& verb, RecordedRunOptions& options, bool live_too) {
  verb.add_option(live_too ? "source" : "recording", options.recording,
                  std::string("An .mcap or .csv.gz recording, or a case folder") +
                      (live_too ? "; or the word live" : ""))
      ->required();
  verb.add_option("-o,--output", options.folder, "The folder to write to")->required();
  verb.add_option("--calibration", options.calibration_file,
                  "Of a recording: a calibration.yaml [its own, else alpha as drawn]");
}

std::string asked_rig_file(const CLI::App& verb, const CommonOptions& common) {
  return verb.count("--rig") > 0 ? common.rig_file : "";
}

RigFile begin_live(const CommonOptions& common, const RecordedRunOptions& options) {
  start_log("swivel", common.log_level == "info" ? "warning" : common.log_level);
  if (!options.calibration_file.empty())
    throw ExitError(kExitUsage, "--calibration is for recordings; a live rig has its own");
  return load_rig_file(common.rig_file);
}

}  // namespace swivel
