// swivel report RECORDING|live -o DIR: the paper's evaluation as numbers, pictures and a page.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/common/program.hpp"
#include "components/swivel/live/scan.hpp"
#include "components/swivel/report/sweep_evaluator.hpp"
#include "components/swivel/source_options.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ReportOptions {
  RecordedRunOptions source;
  std::string truth_file;
  ScanOptions scan;  // live
};

// The file asked for, or the one beside the recording; else nothing.
std::optional<AttitudeTruth> truth_of(const ReportOptions& options) {
  if (!options.truth_file.empty()) return AttitudeTruth(options.truth_file);
  const std::filesystem::path beside =
      std::filesystem::path(options.source.recording) / "truth.csv";
  if (options.source.recording == kLive || !std::filesystem::exists(beside)) return std::nullopt;
  return AttitudeTruth(beside);
}

void conclude(const ReportOptions& options, SweepEvaluator& evaluator, OutputFolder& output) {
  evaluator.finish(truth_of(options), output);
  output.finish();
  std::cout << "see " << options.source.folder << "/report.html, report.json" << std::endl;
}

int report_recording(const ReportOptions& options) {
  RecordedRun run(options.source);
  SweepEvaluator evaluator(options.source.folder, run.title(), run.rig(), run.room_yaw_deg());
  run.run([&](const ProcessedSweep& processed) { return evaluator.add(processed); });
  conclude(options, evaluator, run.output());
  return run.exit_code();
}

int report_live(const CommonOptions& common, const ReportOptions& options, StopSignal& stop) {
  const RigFile rig = begin_live(common, options.source);
  check_mode(rig, options.scan.mode);
  OutputFolder output(options.source.folder, rig.rig, rig, options.source.kinds);
  SweepEvaluator evaluator(options.source.folder, rig.rig, rig, 0.0);
  const int good =
      scan_live(common.participant("swivel_report", rig.rig), options.scan, output, stop,
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
  options->source.kinds.no_clouds = true;
  add_source_options(*verb, options->source, true);
  verb->add_option("--truth", options->truth_file,
                   "What a simulator says of the sweeps [truth.csv in a case folder]");
  verb->add_option("--mode", options->scan.mode, "Live: of the sweeps")->capture_default_str();
  verb->add_option("--count", options->scan.count, "Live: how many sweeps")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    options->source.rig_file = asked_rig_file(*verb, *common);
    chosen = [=, &stop] {
      return options->source.recording == kLive ? report_live(*common, *options, stop)
                                                : report_recording(*options);
    };
  });
}

}  // namespace swivel
