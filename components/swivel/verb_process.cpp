// swivel process RECORDING -o DIR: clouds, pictures and numbers from a recording.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

#include "components/attitude_corrector/corrector.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/swivel/cloud_files.hpp"
#include "components/swivel/offline_pipeline.hpp"
#include "components/swivel/pictures.hpp"
#include "components/swivel/sweep_report.hpp"
#include "components/swivel/text_file.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ProcessOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;
  std::string calibration_file;
  bool no_clouds = false;
  bool no_pictures = false;
};

void require(const Outcome& outcome) {
  if (!outcome) throw ExitError(kExitInputOutput, outcome.reason());
}

// Writes what belongs to each sweep as it comes, and keeps what is written at the end.
class OutputFolder {
 public:
  OutputFolder(const ProcessOptions& options, const RecordingFacts& facts, const RigFile& rig)
      : options_(options), measured_(rig.axis_measured) {
    make_folder(options.folder);
    report_["version"] = SWIVEL_VERSION;
    report_["recording"] = options.recording;
    report_["rig_file"] = rig.path;
    report_["calibration_file"] = options.calibration_file;
    report_["estimator"] = rig.axis_measured ? "" : rig.estimator;
    report_["scan_period_ms"] = facts.scan_period_ns * 1e-6;
    report_["sign_of_phi_offset"] =
        "counter-clockwise seen from above; turns a cloud from its start position O' into O";
    report_["sweeps"] = nlohmann::ordered_json::array();
  }

  void add(const ProcessedSweep& processed) {
    attitude_csv_ += attitude_csv_row(processed);
    nlohmann::ordered_json json = sweep_json(processed);
    if (!processed.cloud.points.empty()) {
      if (!options_.no_clouds) write_clouds(processed, json);
      if (!options_.no_pictures) write_pictures(processed, json);
    }
    report_["sweeps"].push_back(std::move(json));
    std::cout << sweep_in_words(processed) << std::endl;
  }

  void finish() const {
    write_text_file(options_.folder + "/attitude.csv", attitude_csv_);
    write_text_file(options_.folder + "/report.json", report_.dump(2) + "\n");
  }

  std::size_t sweeps() const { return report_["sweeps"].size(); }

 private:
  std::string file(const std::string& kind, const ProcessedSweep& processed,
                   const std::string& ending) const {
    std::ostringstream name;
    name << options_.folder << "/" << kind << "_" << std::setw(2) << std::setfill('0')
         << processed.index << ending;
    return name.str();
  }

  void write_clouds(const ProcessedSweep& processed, nlohmann::ordered_json& json) const {
    require(write_pcd(file("cloud", processed, ".pcd"), processed.cloud));
    const auto left_out = write_ply(file("cloud", processed, ".ply"), processed.cloud);
    if (!left_out) throw ExitError(kExitInputOutput, left_out.reason());
    json["invalid_points_left_out_of_ply"] = *left_out;
  }

  void write_pictures(const ProcessedSweep& processed, nlohmann::ordered_json& json) const {
    PictureCaption caption;
    caption.title = std::filesystem::path(options_.recording).lexically_normal().filename();
    caption.sweep = processed.index;
    caption.mode = processed.attitude.mode();
    caption.verdict = verdict_word(processed.attitude.verdict());
    const bool corrected = processed.attitude.verdict() == msg::VERDICT_GOOD;
    caption.frame = measured_ ? "base" : corrected ? "O" : "O'";
    if (corrected) caption.phi_offset_rad = rad_from_deg(processed.attitude.phi_offset_deg());
    require(write_top_view(file("top_view", processed, ".png"),
                           corrected ? &processed.raw : nullptr, processed.cloud, caption));
    require(write_density_view(file("density", processed, ".png"), processed.cloud, caption));
    json["top_view"] = std::filesystem::path(file("top_view", processed, ".png")).filename();
  }

  const ProcessOptions& options_;
  bool measured_;
  std::string attitude_csv_ = attitude_csv_heading();
  nlohmann::ordered_json report_;
};

int process(const ProcessOptions& options) {
  Recording recording = open_recording(options.recording);
  const RecordingFacts facts = recording.facts();
  const RigFile rig = rig_of(facts, options.recording, options.rig_file);
  std::optional<msg::Calibration> calibration;
  if (!options.calibration_file.empty()) calibration = load_calibration(options.calibration_file);

  OutputFolder output(options, facts, rig);
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
  verb->add_flag("--no-clouds", options->no_clouds, "Write no PCD and PLY");
  verb->add_flag("--no-pictures", options->no_pictures, "Write no PNG");
  verb->callback([options, &chosen] { chosen = [options] { return process(*options); }; });
}

}  // namespace swivel
