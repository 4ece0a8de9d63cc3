#include "components/swivel/offline/recorded_mounting.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "components/alpha_calibrator/mounting_calibration.hpp"
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/json_text.hpp"
#include "components/common/listed.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline/mounting_json.hpp"
#include "components/swivel/offline/mounting_pictures.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

using Json = nlohmann::ordered_json;

// What was seen from one place, in one sweep or two.
struct RecordedView {
  std::vector<std::size_t> sweeps;  // counted from 0
  int mode = 0;
  SweepReadings readings;
};

struct FittedView {
  RecordedView view;  // its readings are gone
  MountingResult result;
  std::optional<std::vector<double>> roof_m;
};

// A sweep down that follows one up saw the same surroundings: both together show hysteresis.
bool continues(const RecordedView& before, const SweepReadings& readings) {
  const SweepReadings& seen = before.readings;
  return before.sweeps.size() == 1 && seen.beams() == readings.beams() &&
         seen.lines.front().turning_down != readings.lines.front().turning_down;
}

std::vector<RecordedView> views_of(Recording& recording, const RigFile& rig, bool per_sweep) {
  const AssemblyOptions options{rig.geometry, rig.axis_measured, rig.timing,
                                rad_from_deg(rig.modes.sweep_angle_deg), true};
  std::vector<RecordedView> views;
  std::size_t sweeps = 0;
  Assembler assembler(options, [&](AssembledSweep&& assembled) {
    const std::size_t index = sweeps++;
    if (!assembled.sweep.reason().empty())
      std::cout << "sweep " << index << ": " << assembled.sweep.reason() << std::endl;
    if (assembled.readings.lines.empty()) return;
    if (!per_sweep && rig.axis_measured && !views.empty() &&
        continues(views.back(), assembled.readings)) {
      auto& lines = views.back().readings.lines;
      std::move(assembled.readings.lines.begin(), assembled.readings.lines.end(),
                std::back_inserter(lines));
      views.back().sweeps.push_back(index);
    } else {
      views.push_back({{index}, assembled.sweep.mode(), std::move(assembled.readings)});
    }
  });
  play(recording, assembler, pass_over);
  return views;
}

std::string name_of_sweeps(const std::vector<std::size_t>& sweeps) {
  return fmt::format("sweep{} {}", sweeps.size() == 1 ? "" : "s", listed(sweeps));
}

Json to_json(const FittedView& fitted) {
  Json json;
  if (fitted.result.fit) {
    json = mounting_json(fitted.view.sweeps, *fitted.result.fit);
    if (fitted.roof_m) json["roof_mean_deviation_mm"] = roof_json(*fitted.roof_m);
    return json;
  }
  if (fitted.view.sweeps.size() == 1) json["sweep"] = fitted.view.sweeps.front();
  json["sweeps"] = fitted.view.sweeps;
  json["refused"] = fitted.result.reason;
  return json;
}

// The mounting of some views, in the files of one run.
class MountingOutput {
 public:
  MountingOutput(const RecordedMountingOptions& options, const RigFile& rig)
      : options_(options), rig_(rig) {
    make_folder(options.folder);
    report_["recording"] = options.recording;
    report_["rig"] = rig.rig;
    report_["sweeps"] = Json::array();
  }

  void add_each(const std::vector<FittedView>& fitted) {
    for (const FittedView& each : fitted) {
      report_["sweeps"].push_back(to_json(each));
    }
  }
  void add_joint(const std::vector<std::size_t>& sweeps, const JointMounting& joint,
                 const std::vector<FittedView>& fitted) {
    Json json = mounting_json(sweeps, joint.fit);
    if (fitted.size() == 1 && fitted.front().roof_m)
      json["roof_mean_deviation_mm"] = roof_json(*fitted.front().roof_m);
    json["chi_square"] = joint.scatter.sum;
    json["degrees_of_freedom"] = joint.scatter.freedom;
    report_["sweeps"].push_back(std::move(json));
  }
  void warn(const std::string& words) { report_["warning"] = words; }
  void finish() const {
    write_text_file(options_.folder + "/mounting.json", json_text(report_, 2) + "\n");
  }

  void save(const msg::Calibration& found, const std::string& name) const {
    msg::Calibration calibration = found;
    calibration.provenance(found.provenance() + "; from the recording " + options_.recording);
    const std::string path = options_.folder + "/" + name;
    const std::string reason = save_calibration(calibration, path);
    if (!reason.empty()) throw ExitError(kExitInputOutput, reason);
    std::cout << "written to " << path << std::endl;
  }

  // Each with a calibration of its own.
  void save_each(const std::vector<FittedView>& fitted) const {
    for (const FittedView& each : fitted) {
      MountingCalibration alone(rig_);
      if (!alone.add(each.view.mode, each.result).used) continue;
      const auto outcome = alone.fit({}, now_ns());
      const bool single = fitted.size() == 1;
      const std::string name = fmt::format("calibration_{:02}.yaml", each.view.sweeps.front());
      if (outcome.calibration) save(*outcome.calibration, single ? "calibration.yaml" : name);
    }
  }

 private:
  const RecordedMountingOptions& options_;
  const RigFile& rig_;
  Json report_;
};

void finish_together(const std::vector<FittedView>& fitted, const RigFile& rig,
                     MountingOutput& output) {
  MountingCalibration together(rig);
  std::vector<MountingFit> fits;
  std::vector<std::size_t> sweeps;
  for (const FittedView& each : fitted) {
    if (!together.add(each.view.mode, each.result).used) continue;
    fits.push_back(*each.result.fit);
    sweeps.insert(sweeps.end(), each.view.sweeps.begin(), each.view.sweeps.end());
  }
  const JointMounting joint = join_mountings(fits, rig.geometry);
  if (!joint.scatter.by_chance()) {
    const std::string words = fmt::format(
        "the sweeps differ in their mounting (chi-square {:.0f} of {}): the lidar was moved on its "
        "axis between them; use --per-sweep",
        joint.scatter.sum, joint.scatter.freedom);
    output.warn(words);
    output.add_each(fitted);
    output.finish();
    throw ExitError(kExitBadData, words);
  }
  output.add_joint(sweeps, joint, fitted);
  const auto outcome = together.fit({}, now_ns());
  std::cout << outcome.words << std::endl;
  output.finish();
  if (outcome.calibration) output.save(*outcome.calibration, "calibration.yaml");
}

std::vector<FittedView> fit_each(std::vector<RecordedView> views, const RigFile& rig,
                                 MountingPictures& pictures) {
  std::vector<FittedView> fitted;
  for (RecordedView& view : views) {
    MountingResult result = fit_mounting(view.readings, rig.geometry);
    std::optional<std::vector<double>> roof_m;
    if (result.fit) roof_m = pictures.add(view.sweeps.front(), view.readings, *result.fit);
    view.readings.lines.clear();
    std::cout << name_of_sweeps(view.sweeps) << ": "
              << (result.fit ? mounting_in_words(*result.fit) : "left out: " + result.reason)
              << std::endl;
    fitted.push_back({std::move(view), std::move(result), std::move(roof_m)});
  }
  return fitted;
}

}  // namespace

void calibrate_recorded_mounting(const RecordedMountingOptions& options) {
  Recording recording = open_recording(options.recording);
  const RigFile rig = rig_of(recording.facts(), options.recording, options.rig_file);
  MountingOutput output(options, rig);
  const std::string title = std::filesystem::path(options.recording).lexically_normal().filename();
  MountingPictures pictures(options.folder, title, rig.geometry);
  const auto fitted = fit_each(views_of(recording, rig, options.per_sweep), rig, pictures);
  pictures.draw_biases({});
  const bool any = std::any_of(fitted.begin(), fitted.end(),
                               [](const FittedView& each) { return each.result.fit.has_value(); });
  if (!any) {
    throw ExitError(kExitBadData, options.recording + ": no sweep shows the mounting" +
                                      (fitted.empty() ? "" : ": " + fitted.front().result.reason));
  }
  if (!options.per_sweep) return finish_together(fitted, rig, output);
  output.add_each(fitted);
  output.finish();
  output.save_each(fitted);
}

}  // namespace swivel
