#include "components/swivel/offline/recorded_mounting.hpp"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "components/alpha_calibrator/mounting_calibration.hpp"
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
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
};

// The direction is the sweep's: a stop-and-go line stands still.
bool mark_direction(SweepReadings& readings) {
  const bool down = readings.lines.back().axis_angle_rad < readings.lines.front().axis_angle_rad;
  for (LineOfReadings& line : readings.lines) line.turning_down = down;
  return down;
}

// A sweep down that follows one up saw the same surroundings: both together show hysteresis.
bool continues(const RecordedView& before, const SweepReadings& readings) {
  const SweepReadings& seen = before.readings;
  return before.sweeps.size() == 1 && seen.beams() == readings.beams() &&
         seen.lines.front().turning_down != readings.lines.front().turning_down;
}

std::vector<RecordedView> views_of(Recording recording, const RigFile& rig, bool per_sweep) {
  const AssemblyOptions options{rig.geometry, rig.axis_measured, rig.timing,
                                rad_from_deg(rig.modes.sweep_angle_deg), true};
  std::vector<RecordedView> views;
  Assembler assembler(options, [&](AssembledSweep&& assembled) {
    const std::size_t index = assembled.sweep.sweep_id() - 1;
    if (!assembled.sweep.reason().empty())
      std::cout << "sweep " << index << ": " << assembled.sweep.reason() << std::endl;
    if (assembled.readings.lines.empty()) return;
    mark_direction(assembled.readings);
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
  play(std::move(recording), assembler);
  return views;
}

std::string name_of_sweeps(const std::vector<std::size_t>& sweeps) {
  return fmt::format("sweep{} {}", sweeps.size() == 1 ? "" : "s", fmt::join(sweeps, ", "));
}

void put(Json& json, const std::string& name, const std::string& unit, const MountingFit& fit,
         MountingValue value, double per_unit) {
  json[name + "_" + unit] = per_unit * fit.solution.value[value];
  json[name + "_sigma_" + unit] = per_unit * fit.sigma_of(value);
}

void put_values(Json& json, const MountingFit& fit) {
  put(json, "bias", "deg", fit, kMountingBias, deg_from_rad(1.0));
  put(json, "ry", "deg", fit, kMountingTilt, deg_from_rad(1.0));
  put(json, "tx", "mm", fit, kMountingLeverX, mm_from_m(1.0));
  put(json, "ty", "mm", fit, kMountingLeverY, mm_from_m(1.0));
  if (is_seen(fit.solution, kAxisHysteresis))
    put(json, "hysteresis", "deg", fit, kAxisHysteresis, deg_from_rad(1.0));
  if (is_seen(fit.solution, kRangeOffset))
    put(json, "range_offset", "mm", fit, kRangeOffset, mm_from_m(1.0));
}

Json steps_of(const MountingFit& fit) {
  const SymmetricRaysFit& rays = fit.symmetric_rays;
  Json steps;
  steps["symmetric_rays"] = {{"bias_deg", deg_from_rad(rays.bias_rad)},
                             {"bias_sigma_deg", deg_from_rad(rays.sigma_rad)},
                             {"verified", rays.verified},
                             {"second_half_off_deg", deg_from_rad(rays.second_half_off_rad)},
                             {"pairs", rays.pairs},
                             {"attempts", rays.attempts},
                             {"reason", rays.reason}};
  if (!fit.half_scans) return steps;
  const MountingVector& value = fit.half_scans->solution.value;
  steps["half_scans"] = {{"bias_deg", deg_from_rad(value[kMountingBias])},
                         {"ry_deg", deg_from_rad(value[kMountingTilt])},
                         {"tx_mm", mm_from_m(value[kMountingLeverX])},
                         {"ty_mm", mm_from_m(value[kMountingLeverY])},
                         {"cells", fit.half_scans->cells}};
  return steps;
}

Json to_json(const std::vector<std::size_t>& sweeps, const MountingFit& fit) {
  Json json;
  if (sweeps.size() == 1) json["sweep"] = sweeps.front();
  json["sweeps"] = sweeps;
  put_values(json, fit);
  json["unobservable"] = fit.unobservable;
  json["advice"] = fit.advice;
  json["residual_mm"] = mm_from_m(fit.residual_m);
  if (fit.thickness_m > 0.0) {
    json["largest_planes_nominal_mm"] = mm_from_m(fit.nominal_thickness_m);
    json["largest_planes_mm"] = mm_from_m(fit.thickness_m);
  }
  json["rays_on_planes"] = fit.rays;
  json["cells_seen_twice"] = fit.cells;
  if (fit.symmetric_rays.attempts > 0 || fit.half_scans) json["steps"] = steps_of(fit);
  return json;
}

Json refused_to_json(const FittedView& fitted) {
  Json json;
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
      report_["sweeps"].push_back(each.result.fit ? to_json(each.view.sweeps, *each.result.fit)
                                                  : refused_to_json(each));
    }
  }
  void add_joint(const std::vector<std::size_t>& sweeps, const JointMounting& joint) {
    Json json = to_json(sweeps, joint.fit);
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
  output.add_joint(sweeps, joint);
  const auto outcome = together.fit({}, now_ns());
  std::cout << outcome.words << std::endl;
  output.finish();
  if (outcome.calibration) output.save(*outcome.calibration, "calibration.yaml");
}

std::vector<FittedView> fit_each(std::vector<RecordedView> views, const RigFile& rig) {
  std::vector<FittedView> fitted;
  for (RecordedView& view : views) {
    MountingResult result = fit_mounting(view.readings, rig.geometry);
    view.readings.lines.clear();
    std::cout << name_of_sweeps(view.sweeps) << ": "
              << (result.fit ? mounting_in_words(*result.fit) : "left out: " + result.reason)
              << std::endl;
    fitted.push_back({std::move(view), std::move(result)});
  }
  return fitted;
}

}  // namespace

void calibrate_recorded_mounting(const RecordedMountingOptions& options) {
  Recording recording = open_recording(options.recording);
  const RigFile rig = rig_of(recording.facts(), options.recording, options.rig_file);
  MountingOutput output(options, rig);
  const auto fitted = fit_each(views_of(std::move(recording), rig, options.per_sweep), rig);
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
