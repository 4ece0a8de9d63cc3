#include "components/swivel/offline/recorded_run.hpp"

#include <filesystem>
#include <iostream>
#include <utility>

#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"

namespace swivel {
namespace {

std::optional<msg::Calibration> calibration_in(const std::string& file) {
  return file.empty() ? std::nullopt : std::optional(load_calibration(file));
}

}  // namespace

RecordedRun::RecordedRun(const RecordedRunOptions& options)
    : recording_(open_recording(options.recording)),
      rig_(rig_of(recording_.facts(), options.recording, options.rig_file)),
      calibration_(calibration_in(options.calibration_file)),
      title_(std::filesystem::path(options.recording).lexically_normal().filename()),
      output_(options.folder, title_, rig_, options.kinds) {
  output_.note("recording", options.recording);
  output_.note("calibration_file", options.calibration_file);
  output_.note("scan_period_ms", recording_.facts().scan_period_ns * 1e-6);
}

double RecordedRun::room_yaw_deg() const {
  const auto& plate = recording_.facts().plate;
  return plate ? plate->room_yaw_deg : 0.0;
}

void RecordedRun::run(const Remark& remark) {
  run_offline(recording_, rig_, calibration_, [&](const ProcessedSweep& processed) {
    output_.add(processed, remark ? remark(processed) : nlohmann::ordered_json());
  });
}

int RecordedRun::exit_code() const {
  const std::size_t told = recording_.facts().modes.size();
  if (output_.sweeps() == told) return kExitOk;
  std::cerr << "the recording tells of " << told << " sweeps, " << output_.sweeps()
            << " were made of it\n";
  return kExitInternal;
}

}  // namespace swivel
