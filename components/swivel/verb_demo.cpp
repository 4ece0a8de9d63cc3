// swivel demo: five processes turn the simulated bench's lidar and stepper into corrected
// clouds, and the result is held against the bench's truth.
#include <spdlog/spdlog.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <sstream>

#include "components/swivel/live/calibrate_live.hpp"
#include "components/swivel/live/participants.hpp"
#include "components/swivel/live/roll.hpp"
#include "components/swivel/live/scan.hpp"
#include "components/swivel/live/truth_file.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

constexpr int kDemoDomain = 73;  // so that a demo does not meet a scanner at work

// A worse home switch than the bench's own: the skew is to be seen with the naked eye.
constexpr const char* kHomeSigma_deg = "4";

struct DemoOptions {
  std::string folder = "demo";
  std::vector<int> modes{1, 4};
  int calibration_mode = 3;
  int calibration_sweeps = 3;
  std::uint64_t seed = 3;
  std::string recording;  // empty: none
};

struct BenchAddresses {
  std::string lidar;
  std::string stepper;
};

BenchAddresses await_bench(ChildProcess& bench) {
  const auto line = bench.read_line(std::chrono::seconds(10));
  std::istringstream words(line.value_or(""));
  BenchAddresses addresses;
  std::string lidar;
  std::string stepper;
  words >> lidar >> addresses.lidar >> stepper >> addresses.stepper;
  if (lidar != "lidar" || stepper != "stepper") {
    throw ExitError(kExitUnavailable,
                    "swivel-bench did not start: " + bench.ended().value_or("it says nothing"));
  }
  return addresses;
}

// Records all that the demo's participants say, as a user would.
class DemoRecorder {
 public:
  DemoRecorder(const CommonOptions& common, const std::string& path) {
    if (path.empty()) return;
    const std::vector<std::string> arguments{"record",
                                             "-o",
                                             path,
                                             "--rig",
                                             common.rig_file,
                                             "--domain",
                                             std::to_string(common.domain),
                                             "--network",
                                             common.network,
                                             "--profiles",
                                             common.profiles_file};
    process_ = std::make_unique<ChildProcess>("swivel", arguments);
  }

  // It has said why on stderr.
  void check() {
    if (const auto how = process_ ? process_->ended() : std::nullopt) {
      throw ExitError(kExitInputOutput, "the demo is not recorded: " + *how);
    }
  }

  void finish() {
    if (!process_) return;
    check();
    process_->ask_to_stop();
    if (!process_->wait_or_kill(kPatience) || process_->exit_code() != kExitOk) {
      throw ExitError(kExitInputOutput, "the recording of the demo is not whole");
    }
  }

 private:
  static constexpr auto kPatience = std::chrono::seconds(20);  // a slow disk
  std::unique_ptr<ChildProcess> process_;
};

// Of phi_offset, in deg between -180 and 180.
double attitude_error_deg(const msg::Attitude& attitude, double true_phi_deg) {
  return std::remainder(attitude.phi_offset_deg() - true_phi_deg, 360.0);
}

nlohmann::ordered_json against_truth(const ProcessedSweep& sweep, const std::string& truth_path) {
  const TruthFile truth(truth_path);
  const auto phi_deg = truth.phi_deg(sweep.sweep.first_device_stamp_ms());
  if (!phi_deg) throw ExitError(kExitInternal, "the bench's truth knows nothing of this sweep");
  const double error_deg = attitude_error_deg(sweep.attitude, *phi_deg);
  std::cout << fmt::format("         truth {:.3f} deg, attitude error {:+.3f} deg", *phi_deg,
                           error_deg)
            << std::endl;
  return {{"true_phi_deg", *phi_deg}, {"attitude_error_deg", error_deg}};
}

int run_demo(const CommonOptions& common, const DemoOptions& options, StopSignal& stop) {
  start_log("swivel", "warning");
  const RigFile rig = load_rig_file(common.rig_file);
  for (const int mode : options.modes) check_mode(rig, mode);
  OutputFolder output(options.folder, "simulated bench", rig, {});
  const std::string truth_path = options.folder + "/truth.csv";
  ChildProcess bench("swivel-bench",
                     {"--truth", truth_path, "--seed", std::to_string(options.seed),
                      "--home-sigma-deg", kHomeSigma_deg, "--log-level", "warning"},
                     true);
  const BenchAddresses addresses = await_bench(bench);
  DemoRecorder recorder(common, options.recording);
  CommonOptions quiet = common;
  quiet.log_level = "warning";
  const Participants participants(
      quiet, {"all", addresses.lidar, addresses.stepper, options.folder + "/calibration.yaml"});

  Participant participant(common.participant("swivel_demo", rig.rig));
  const Roll roll(participant);
  LiveSweeps sweeps(participant);
  LiveCalibration calibration(participant);
  participant.start();
  std::cout << "five participants start, the stepper homes ..." << std::endl;
  const std::string missing = roll.await(participants_of("all"), std::chrono::seconds(30));
  if (!missing.empty()) throw ExitError(kExitUnavailable, missing);

  recorder.check();
  std::cout << "alpha is calibrated from the walls ..." << std::endl;
  calibration.run(options.calibration_mode, options.calibration_sweeps, 0.0, stop);
  int good = 0;
  for (const int mode : options.modes) {
    std::cout << "scan in mode " << mode << " ..." << std::endl;
    good += scan(sweeps, {mode, 1, msg::SEQUENCE_IMPROVED}, output, stop,
                 [&](const ProcessedSweep& sweep) { return against_truth(sweep, truth_path); });
  }
  output.note("true_alpha_deg", TruthFile(truth_path).number("alpha_deg").value_or(NAN));
  output.finish();
  recorder.finish();
  std::cout << "see " << options.folder << "/top_view.png, cloud.ply, report.json" << std::endl;
  return good == static_cast<int>(options.modes.size()) ? kExitOk : kExitBadData;
}

}  // namespace

void add_demo(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("demo", "Scans a simulated room, and compares with its truth");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<DemoOptions>();
  common->domain = kDemoDomain;
  verb->add_option("-o,--output", options->folder, "The folder to write to")->capture_default_str();
  verb->add_option("--modes", options->modes, "A sweep of each")
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--calibration-mode", options->calibration_mode, "Of the sweeps for alpha")
      ->capture_default_str();
  verb->add_option("--calibration-sweeps", options->calibration_sweeps, "How many of them")
      ->capture_default_str();
  verb->add_option("--seed", options->seed, "Of the bench")->capture_default_str();
  verb->add_option("--record", options->recording, "FILE.mcap: all that is said, recorded");
  add_common_options(*verb, *common);
  verb->callback(
      [=, &stop, &chosen] { chosen = [=, &stop] { return run_demo(*common, *options, stop); }; });
}

}  // namespace swivel
