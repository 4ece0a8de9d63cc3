// swivel demo: five processes turn the simulated bench's lidar and stepper into corrected
// clouds, and the result is held against the bench's truth.
#include <fmt/core.h>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "components/common/calibration_file.hpp"
#include "components/common/roll.hpp"
#include "components/swivel/live/calibrate_live.hpp"
#include "components/swivel/live/live_axis.hpp"
#include "components/swivel/live/participants.hpp"
#include "components/swivel/live/scan.hpp"
#include "components/swivel/live/truth_file.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

constexpr int kDemoDomain = 73;  // so that a demo does not meet a scanner at work

// A worse home switch than the bench's own: the skew is to be seen with the naked eye.
constexpr const char* kHomeSigma_deg = "4";

// A lidar that was not put on as drawn, on a rig that measures its axis.
constexpr std::array<const char*, 6> kMountingOff{
    "--bias-deg", "3", "--mounting-rpy-deg", "0,0.4,0", "--mounting-xyz-mm", "2,-3,0"};

struct DemoOptions {
  std::string folder = "demo";
  std::vector<int> modes;  // empty: 1, and 4 where the rig has it
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
    std::vector<std::string> arguments = common.as_arguments();
    arguments.insert(arguments.begin(), {"record", "-o", path});
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

nlohmann::ordered_json attitude_against_truth(const ProcessedSweep& sweep, const TruthFile& truth) {
  const auto phi_deg = truth.phi_deg(sweep.sweep.first_device_stamp_ms());
  if (!phi_deg) throw ExitError(kExitInternal, "the bench's truth knows nothing of this sweep");
  const double error_deg = attitude_error_deg(sweep.attitude, *phi_deg);
  std::cout << fmt::format("         truth {:.3f} deg, attitude error {:+.3f} deg", *phi_deg,
                           error_deg)
            << std::endl;
  return {{"true_phi_deg", *phi_deg}, {"attitude_error_deg", error_deg}};
}

nlohmann::ordered_json axis_against_truth(const ProcessedSweep& sweep, const LiveAxis& axis,
                                          const TruthFile& truth) {
  double sum_deg = 0.0;
  double squares = 0.0;
  int lines = 0;
  for (const TruthFile::Line& line : truth.lines()) {
    const bool within = line.beam0_time_ns >= sweep.sweep.window_start_ns() &&
                        line.beam0_time_ns <= sweep.sweep.window_end_ns();
    const auto angle_deg = within ? axis.angle_deg(line.beam0_time_ns) : std::nullopt;
    if (!angle_deg) continue;
    const double error_deg = *angle_deg - line.phi_deg;
    sum_deg += error_deg;
    squares += error_deg * error_deg;
    ++lines;
  }
  if (lines == 0) throw ExitError(kExitInternal, "the bench's truth knows nothing of this sweep");
  const double mean_deg = sum_deg / lines;
  const double rms_deg = std::sqrt(squares / lines);
  std::cout << fmt::format("         axis error against the truth {:+.3f} deg, {:.3f} rms",
                           mean_deg, rms_deg)
            << std::endl;
  return {{"axis_error_mean_deg", mean_deg}, {"axis_error_rms_deg", rms_deg}};
}

// The quickest mode, and a fine one where the rig has it.
std::vector<int> modes_of(const DemoOptions& options, const RigFile& rig) {
  std::vector<int> modes = options.modes;
  for (const int mode : {1, 4}) {
    if (options.modes.empty() && rig.modes.lines.count(mode) != 0) modes.push_back(mode);
  }
  for (const int mode : modes) check_mode(rig, mode);
  return modes;
}

std::vector<std::string> bench_arguments(const RigFile& rig, const DemoOptions& options,
                                         const std::string& truth_path) {
  std::vector<std::string> arguments{
      "--rig",  std::filesystem::path(rig.path).stem(), "--truth",     truth_path,
      "--seed", std::to_string(options.seed),           "--log-level", "warning"};
  if (rig.axis_measured) {
    arguments.insert(arguments.end(), kMountingOff.begin(), kMountingOff.end());
  } else {
    arguments.insert(arguments.end(), {"--home-sigma-deg", kHomeSigma_deg});
  }
  return arguments;
}

void calibrate_alpha(LiveCalibration& calibration, const DemoOptions& options, StopSignal& stop) {
  std::cout << "alpha is calibrated from the walls ..." << std::endl;
  calibration.run(calibration_request(msg::CALIBRATION_OF_ALPHA, options.calibration_mode,
                                      options.calibration_sweeps),
                  stop);
}

// What was found against what the bench was built with.
void calibrate_mounting(LiveCalibration& calibration, const std::string& folder,
                        OutputFolder& output, StopSignal& stop) {
  std::cout << "the mounting is calibrated from the room ..." << std::endl;
  calibration.run(calibration_request(msg::CALIBRATION_OF_MOUNTING, 1, 1), stop);
  const msg::Calibration found = load_calibration(folder + "/calibration.yaml");
  const TruthFile truth(folder + "/truth.csv");
  const double true_bias_deg = truth.number("bias_deg").value_or(NAN);
  std::cout << fmt::format("         truth: bias {:.4f} deg", true_bias_deg) << std::endl;
  output.note("bias_deg", found.bias_deg());
  output.note("true_bias_deg", true_bias_deg);
}

int run_demo(const CommonOptions& common, const DemoOptions& options, StopSignal& stop) {
  start_log("swivel", "warning");
  const RigFile rig = load_rig_file(common.rig_file);
  const std::vector<int> modes = modes_of(options, rig);
  OutputFolder output(options.folder, "simulated bench", rig, {});
  const std::string truth_path = options.folder + "/truth.csv";
  ChildProcess bench("swivel-bench", bench_arguments(rig, options, truth_path), true);
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
  const LiveAxis axis(participant);
  participant.start();
  std::cout << "five participants start, the stepper homes ..." << std::endl;
  const std::string missing = roll.await(participants_of("all"), std::chrono::seconds(30));
  if (!missing.empty()) throw ExitError(kExitUnavailable, missing);

  recorder.check();
  if (rig.plate) calibrate_alpha(calibration, options, stop);
  if (rig.axis_measured) calibrate_mounting(calibration, options.folder, output, stop);
  int good = 0;
  for (const int mode : modes) {
    std::cout << "scan in mode " << mode << " ..." << std::endl;
    good += scan(sweeps, {mode, 1, msg::SEQUENCE_IMPROVED}, output, stop,
                 [&](const ProcessedSweep& sweep) {
                   const TruthFile truth(truth_path);
                   return rig.axis_measured ? axis_against_truth(sweep, axis, truth)
                                            : attitude_against_truth(sweep, truth);
                 });
  }
  if (rig.plate) {
    output.note("true_alpha_deg", TruthFile(truth_path).number("alpha_deg").value_or(NAN));
  }
  output.finish();
  recorder.finish();
  std::cout << "see " << options.folder << "/top_view.png, cloud.ply, report.json" << std::endl;
  return good == static_cast<int>(modes.size()) ? kExitOk : kExitBadData;
}

}  // namespace

void add_demo(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("demo", "Scans a simulated room, and compares with its truth");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<DemoOptions>();
  common->domain = kDemoDomain;
  verb->add_option("-o,--output", options->folder, "The folder to write to")->capture_default_str();
  verb->add_option("--modes", options->modes, "A sweep of each [1, and 4 where the rig has it]")
      ->delimiter(',');
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
