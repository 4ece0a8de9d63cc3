// swivel scan: asks a live rig for sweeps; clouds, pictures and numbers.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "components/swivel/live/scan.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ScanVerbOptions {
  ScanOptions scan;
  OutputKinds kinds;
  std::string folder;
};

const std::map<std::string, msg::SweepSequence> kSequences{
    {"improved", msg::SEQUENCE_IMPROVED},
    {"naive", msg::SEQUENCE_NAIVE},
    {"stop_and_go", msg::SEQUENCE_STOP_AND_GO}};

int run_scan(const CommonOptions& common, const ScanVerbOptions& options, StopSignal& stop) {
  start_log("swivel", common.log_level == "info" ? "warning" : common.log_level);
  const RigFile rig = load_rig_file(common.rig_file);
  check_mode(rig, options.scan.mode);
  OutputFolder output(options.folder, rig.rig, rig, options.kinds);
  const int good =
      scan_live(common.participant("swivel_scan", rig.rig), options.scan, output, stop);
  output.finish();
  return good == options.scan.count ? kExitOk : kExitBadData;
}

}  // namespace

void add_scan(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand("scan", "Asks a live rig for sweeps");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<ScanVerbOptions>();
  verb->add_option("--mode", options->scan.mode, "1 is the quickest, 7 the finest")
      ->capture_default_str();
  verb->add_option("--count", options->scan.count, "How many sweeps")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("--sequence", options->scan.action_sequence,
                   "improved; naive: lidar and motor start together; stop_and_go")
      ->transform(CLI::CheckedTransformer(kSequences))
      ->option_text("improved|naive|stop_and_go");
  verb->add_option("-o,--output", options->folder, "The folder to write to")->required();
  verb->add_flag("--no-clouds", options->kinds.no_clouds, "Write no PCD and PLY");
  verb->add_flag("--no-pictures", options->kinds.no_pictures, "Write no PNG");
  add_common_options(*verb, *common);
  verb->callback(
      [=, &stop, &chosen] { chosen = [=, &stop] { return run_scan(*common, *options, stop); }; });
}

}  // namespace swivel
