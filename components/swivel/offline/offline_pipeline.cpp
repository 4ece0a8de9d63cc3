#include "components/swivel/offline/offline_pipeline.hpp"

#include <filesystem>
#include <iostream>
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

AssemblyOptions assembly_options(const RigFile& rig) {
  const bool keep_readings = rig.axis_measured;  // the mounting is judged by them
  return {rig.geometry, rig.axis_measured, rig.timing, rad_from_deg(rig.modes.sweep_angle_deg),
          keep_readings};
}

// Assembler and corrector, one after the other.
class Stages {
 public:
  Stages(const RigFile& rig, std::function<void(const ProcessedSweep&)> on_sweep)
      : drawn_(rig.geometry),
        on_sweep_(std::move(on_sweep)),
        corrector_(rig),
        assembler_(assembly_options(rig),
                   [this](AssembledSweep&& assembled) { take(std::move(assembled)); }) {}

  // From the next sweep on. Says why it is refused, or nothing.
  std::string calibrate(const msg::Calibration& calibration) {
    std::string wrong = corrector_.set_calibration(calibration);
    if (wrong.empty()) assembler_.set_geometry(calibrated_geometry(drawn_, calibration));
    return wrong;
  }

  void run(Recording& recording, const OnCalibration& on_calibration) {
    play(recording, assembler_, on_calibration);
    hand_out();
  }

 private:
  // A sweep may be taken back when its motor fails after its last line: then it comes again.
  void take(AssembledSweep&& assembled) {
    const bool again = last_ && last_->sweep.sweep_id() == assembled.sweep.sweep_id();
    if (!again) hand_out();
    ProcessedSweep processed;
    processed.index = handed_out_;
    processed.sweep = assembled.sweep;
    processed.raw = assembled.cloud;
    processed.cloud = std::move(assembled.cloud);
    processed.readings = std::move(assembled.readings);
    processed.attitude = corrector_.correct(processed.sweep, processed.cloud);
    last_ = std::move(processed);
  }

  void hand_out() {
    if (!last_) return;
    on_sweep_(*last_);
    last_.reset();
    ++handed_out_;
  }

  RigGeometry drawn_;
  std::function<void(const ProcessedSweep&)> on_sweep_;
  Corrector corrector_;
  std::optional<ProcessedSweep> last_;
  std::size_t handed_out_ = 0;
  Assembler assembler_;
};

// The shipped rig file of that name of topics.
std::string shipped_file_of(const std::string& rig, const std::string& path) {
  for (const auto& entry : std::filesystem::directory_iterator(shared_file("rigs"))) {
    if (load_rig_file(entry.path()).rig == rig) return entry.path();
  }
  throw ExitError(kExitUsage, path + ": it is of rig '" + rig + "'; give its file with --rig");
}

std::string suited_file_of(const RecordingFacts& facts, const std::string& path) {
  if (!facts.rig.empty()) return shipped_file_of(facts.rig, path);
  return shared_file("rigs/" + (facts.suggested_rig.empty() ? "yuan" : facts.suggested_rig) +
                     ".yaml");
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
  RigFile rig = load_rig_file(rig_file.empty() ? suited_file_of(facts, path) : rig_file);
  if (rig_file.empty() && facts.plate) take_plate(*facts.plate, rig);
  check_source(facts, path, rig);
  return rig;
}

void play(Recording& recording, Assembler& assembler, const OnCalibration& on_calibration) {
  while (true) {
    const auto event = recording.next();
    if (!event) throw ExitError(kExitBadData, event.reason());
    if (!event->has_value()) break;
    std::visit(
        [&](const auto& message) {
          if constexpr (std::is_same_v<decltype(message), const msg::Calibration&>)
            on_calibration(message);
          else
            assembler.add(message);
        },
        (*event)->message);
  }
  assembler.finish();
}

void run_offline(Recording& recording, const RigFile& rig,
                 const std::optional<msg::Calibration>& calibration,
                 const std::function<void(const ProcessedSweep&)>& on_sweep) {
  Stages stages(rig, on_sweep);
  if (!calibration)
    return stages.run(recording, [&](const msg::Calibration& recorded) {
      const std::string wrong = stages.calibrate(recorded);
      if (!wrong.empty()) std::cerr << "a recorded calibration is not used: " << wrong << '\n';
    });
  const std::string wrong = stages.calibrate(*calibration);
  if (!wrong.empty()) throw ExitError(kExitBadData, "the calibration was refused: " + wrong);
  stages.run(recording, pass_over);
}

void run_offline_as_drawn(Recording& recording, const RigFile& rig,
                          const std::function<void(const ProcessedSweep&)>& on_sweep) {
  Stages(rig, on_sweep).run(recording, pass_over);
}

}  // namespace swivel
