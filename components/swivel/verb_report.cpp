// swivel report RECORDING|live -o DIR: the paper's evaluation as numbers, pictures and a page.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/common/calibration_file.hpp"
#include "components/common/program.hpp"
#include "components/swivel/live/roll.hpp"
#include "components/swivel/live/scan.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/report/sweep_evaluator.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ReportOptions {
  std::string source;
  std::string folder;
  std::string rig_file;  // empty: that which suits
  std::string calibration_file;
  std::string truth_file;
  ScanOptions scan;
};

constexpr const char* kLive = "live";
constexpr OutputKinds kNoClouds{true, false};

// The file asked for, or the one beside the recording; else nothing.
std::optional<AttitudeTruth> truth_of(const ReportOptions& options) {
  if (!options.truth_file.empty()) return AttitudeTruth(options.truth_file);
  const std::filesystem::path beside = std::filesystem::path(options.source) / "truth.csv";
  if (options.source == kLive || !std::filesystem::exists(beside)) return std::nullopt;
  return AttitudeTruth(beside);
}

void conclude(const ReportOptions& options, SweepEvaluator& evaluator, OutputFolder& output) {
  evaluator.finish(truth_of(options), output);
  output.finish();
  std::cout << "see " << options.folder << "/report.html, report.json" << std::endl;
}

int report_recording(const ReportOptions& options) {
  Recording recording = open_recording(options.source);
  const RecordingFacts facts = recording.facts();
  const RigFile rig = rig_of(facts, options.source, options.rig_file);
  std::optional<msg::Calibration> calibration;
  if (!options.calibration_file.empty()) calibration = load_calibration(options.calibration_file);
  const std::string title = std::filesystem::path(options.source).lexically_normal().filename();

  OutputFolder output(options.folder, title, rig, kNoClouds);
  output.note("recording", options.source);
  output.note("calibration_file", options.calibration_file);
  SweepEvaluator evaluator(options.folder, title, rig,
                           facts.plate ? facts.plate->room_yaw_deg : 0.0);
  run_offline(
      std::move(recording), rig, calibration,
      [&](const ProcessedSweep& processed) { output.add(processed, evaluator.add(processed)); },
      rig.axis_measured ? Readings::kKept : Readings::kForgotten);
  conclude(options, evaluator, output);
  return output.sweeps() == facts.modes.size() ? kExitOk : kExitInternal;
}

int report_live(const CommonOptions& common, const ReportOptions& options, StopSignal& stop) {
  start_log("swivel", common.log_level == "info" ? "warning" : common.log_level);
  if (!options.calibration_file.empty())
    throw ExitError(kExitUsage, "--calibration is for recordings; a live rig has its own");
  const RigFile rig = load_rig_file(common.rig_file);
  check_mode(rig, options.scan.mode);
  OutputFolder output(options.folder, rig.rig, rig, kNoClouds);
  SweepEvaluator evaluator(options.folder, rig.rig, rig, 0.0);
  Participant participant(common.participant("swivel_report", rig.rig));
  const Roll roll(participant);
  LiveSweeps sweeps(participant);
  participant.start();
  const std::string missing = roll.await(scanning_participants(), std::chrono::seconds(30));
  if (!missing.empty()) throw ExitError(kExitUnavailable, missing + "; start them with: swivel up");
  const int good = scan(sweeps, options.scan, output, stop,
                        [&](const ProcessedSweep& processed) { return evaluator.add(processed); });
  conclude(options, evaluator, output);
  return good == options.scan.count ? kExitOk : kExitBadData;
}

}  // namespace

void add_report(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("report", "Judges a recording or a live rig: numbers, pictures, a page");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<ReportOptions>();
  verb->add_option("source", options->source,
                   "A .csv.gz recording, a case folder, or the word live")
      ->required();
  verb->add_option("-o,--output", options->folder, "The folder to write to")->required();
  verb->add_option("--calibration", options->calibration_file,
                   "Recordings: a calibration.yaml [alpha as drawn]");
  verb->add_option("--truth", options->truth_file,
                   "What a simulator says of the sweeps [truth.csv in a case folder]");
  verb->add_option("--mode", options->scan.mode, "Live: of the sweeps")->capture_default_str();
  verb->add_option("--count", options->scan.count, "Live: how many sweeps")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    options->rig_file = verb->count("--rig") > 0 ? common->rig_file : "";
    chosen = [=, &stop] {
      return options->source == kLive ? report_live(*common, *options, stop)
                                      : report_recording(*options);
    };
  });
}

}  // namespace swivel
