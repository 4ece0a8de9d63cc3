#include "components/swivel/offline/offline_pipeline.hpp"

#include <filesystem>
#include <utility>

#include "components/attitude_corrector/corrector.hpp"
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/program.hpp"

namespace swivel {
namespace {

// What the recording says of its own plate is nearer to the truth than any file beside it.
void take_plate(const RecordingFacts::Plate& recorded, RigFile& rig) {
  rig.geometry.T_axis_lidar.translation().x() = recorded.lever_arm_m;
  if (!rig.plate) rig.plate.emplace();
  rig.plate->base_distance_m = recorded.base_distance_m;
  rig.plate->hypotenuse_m = recorded.hypotenuse_m;
  rig.plate->depth_m = recorded.depth_m;
  rig.plate->alpha_rad = rad_from_deg(recorded.alpha_deg);
}

void check_source(const RecordingFacts& facts, const std::string& path, const RigFile& rig) {
  if (facts.modes.empty()) {
    const std::string why = facts.remark.empty() ? "it has no sweep" : facts.remark;
    throw ExitError(kExitBadData, path + ": no cloud can be made of this recording: " + why);
  }
  if (facts.axis_measured == rig.axis_measured) return;
  throw ExitError(kExitBadData, path + ": the recording's axis was " +
                                    (facts.axis_measured ? "measured" : "commanded") + ", " +
                                    rig.path + " says otherwise; give the right one with --rig");
}

}  // namespace

Recording open_recording(const std::string& path) {
  if (!std::filesystem::exists(path))
    throw ExitError(kExitNoInput, path + ": there is no such file or folder");
  auto recording = Recording::open(path);
  if (!recording) throw ExitError(kExitBadData, recording.reason());
  return std::move(*recording);
}

RigFile rig_of(const RecordingFacts& facts, const std::string& path, const std::string& rig_file) {
  const std::string suggested = facts.suggested_rig.empty() ? "yuan" : facts.suggested_rig;
  RigFile rig =
      load_rig_file(rig_file.empty() ? shared_file("rigs/" + suggested + ".yaml") : rig_file);
  if (rig_file.empty() && facts.plate) take_plate(*facts.plate, rig);
  check_source(facts, path, rig);
  return rig;
}

void play(Recording recording, Assembler& assembler) {
  while (true) {
    auto event = recording.next();
    if (!event) throw ExitError(kExitBadData, event.reason());
    if (!event->has_value()) break;
    std::visit([&](const auto& message) { assembler.add(message); }, (*event)->message);
  }
  assembler.finish();
}

void run_offline(Recording recording, const RigFile& rig,
                 const std::optional<msg::Calibration>& calibration,
                 const std::function<void(ProcessedSweep&&)>& on_sweep, Readings readings) {
  Corrector corrector(rig);
  AssemblyOptions options{rig.geometry, rig.axis_measured, rig.timing,
                          rad_from_deg(rig.modes.sweep_angle_deg), readings == Readings::kKept};
  if (calibration) {
    const std::string wrong = corrector.set_calibration(*calibration);
    if (!wrong.empty()) throw ExitError(kExitBadData, "the calibration was refused: " + wrong);
    options.geometry = calibrated_geometry(rig.geometry, *calibration);
  }
  Assembler assembler(options, [&](AssembledSweep&& assembled) {
    ProcessedSweep processed;
    processed.index = assembled.sweep.sweep_id() - 1;
    processed.sweep = assembled.sweep;
    processed.raw = assembled.cloud;
    processed.cloud = std::move(assembled.cloud);
    processed.readings = std::move(assembled.readings);
    processed.attitude = corrector.correct(processed.sweep, processed.cloud);
    on_sweep(std::move(processed));
  });
  play(std::move(recording), assembler);
}

}  // namespace swivel
