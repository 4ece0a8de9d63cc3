// swivel record: topics into an MCAP file, byte for byte.
// swivel capture: likewise, what passes between the computer and the devices.
#include <fmt/core.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/swivel/recorder/recorder.hpp"
#include "components/swivel/recorder/topics_named.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct RecordOptions {
  std::string path;
  std::vector<std::string> topics;
  std::uint64_t split_mb = 0;
  std::uint64_t margin_mb = 200;
  int last_s = 0;
};

// SIGUSR1, which then reaches received() alone. Must be made before any thread.
class TriggerSignal {
 public:
  TriggerSignal() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  bool received() {
    const timespec at_once{0, 0};
    return sigtimedwait(&signals_, nullptr, &at_once) > 0;
  }

 private:
  sigset_t signals_;
};

RecorderOptions recorder_options(const RecordOptions& options) {
  RecorderOptions recorder;
  recorder.path = options.path;
  if (options.split_mb > 0) recorder.limits.split_bytes = options.split_mb << 20;
  recorder.limits.disk_margin_bytes = options.margin_mb << 20;
  if (options.last_s > 0) recorder.last = std::chrono::seconds(options.last_s);
  return recorder;
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) * 1e-6;
}

void print_progress(const Recorder& recorder) {
  const TopicCount total = recorder.summary().total();
  std::cerr << fmt::format("\r{} messages, {:.1f} MB, {} lost ", total.messages,
                           megabytes(total.bytes), total.lost + total.dropped);
}

void print(const RecorderSummary& summary) {
  for (const auto& [topic, count] : summary.topics) {
    std::cout << fmt::format("{:<32} {:>8} messages {:>9.1f} MB", topic, count.messages,
                             megabytes(count.bytes));
    if (count.lost > 0) std::cout << fmt::format(", {} lost on the way", count.lost);
    if (count.dropped > 0) std::cout << fmt::format(", {} not written", count.dropped);
    std::cout << '\n';
  }
  for (const std::string& file : summary.files) {
    if (std::filesystem::exists(file)) std::cout << "see " << file << '\n';
  }
}

// Of a rig's misbehaviour: both wires, what was asked of it and what it said of itself. Lines and
// clouds follow from the bytes.
std::vector<std::string> topics_of_a_capture() {
  return {kWireTopic.name,  kHealthTopic.name,      kSweepRequestTopic.name,
          kSweepTopic.name, kCalibrationTopic.name, kAxisTopic.name};
}

bool has_wire(const RecorderSummary& summary) {
  return std::any_of(summary.topics.begin(), summary.topics.end(), [](const auto& topic) {
    const auto known = find_topic(topic.first);
    return known && known->topic.is(kWireTopic);
  });
}

int judge(const RecorderSummary& summary, const RecordOptions& options) {
  const TopicCount total = summary.total();
  if (!summary.failure.empty()) {
    throw ExitError(kExitInputOutput, summary.failure + "; a .part is read by: swivel recover");
  }
  if (total.messages == 0) {
    throw ExitError(kExitUnavailable,
                    "nothing came: is the rig up, in this --domain and --network?");
  }
  if (options.topics == topics_of_a_capture() && !has_wire(summary)) {
    throw ExitError(kExitUnavailable,
                    "nothing came of the wires: do hokuyo_reader or stepper_sequencer run?");
  }
  if (options.last_s > 0 && summary.files.empty()) {
    throw ExitError(kExitUnavailable, "nothing was written: no trigger (SIGUSR1) came");
  }
  return total.lost + total.dropped == 0 ? kExitOk : kExitBadData;
}

int record(const CommonOptions& common, const RecordOptions& options, StopSignal& stop) {
  start_log("swivel", common.log_level == "info" ? "warning" : common.log_level);
  const RigFile rig = load_rig_file(common.rig_file);
  const auto topics = topics_named(options.topics, rig.rig);
  TriggerSignal trigger;
  Participant participant(common.participant("swivel_record", rig.rig));
  Recorder recorder(participant, topics, recorder_options(options));
  participant.start();
  const bool on_a_terminal = isatty(STDERR_FILENO) == 1;
  while (!stop.wait_for(std::chrono::milliseconds(200)) && !recorder.failed()) {
    if (trigger.received()) recorder.trigger();
    if (on_a_terminal) print_progress(recorder);
  }
  // What was sent before the stop is on its way.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  participant.stop();
  const RecorderSummary summary = recorder.finish();
  if (on_a_terminal) std::cerr << '\n';
  print(summary);
  return judge(summary, options);
}

void add_recording_verb(CLI::App& app, const char* name, const char* purpose, StopSignal& stop,
                        Verb& chosen, const std::vector<std::string>& topics) {
  CLI::App* const verb = app.add_subcommand(name, purpose);
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<RecordOptions>();
  options->topics = topics;
  if (topics.empty()) {
    verb->add_option("topics", options->topics, "scan_line, cloud, ...; none: all but wire");
    // The last seconds of a wire would not tell how its connection began.
    verb->add_option("--last", options->last_s,
                     "Keep the last so many seconds, and write them at each SIGUSR1")
        ->check(CLI::Range(1, 3600));
  }
  verb->add_option("-o,--output", options->path, "FILE.mcap; FILE.mcap.part until it is closed")
      ->required();
  verb->add_option("--split-mb", options->split_mb, "A new file FILE_1.mcap, ... from this size on")
      ->check(CLI::Range(1, 1 << 20));
  verb->add_option("--margin-mb", options->margin_mb, "Stop when less is free on the disk")
      ->check(CLI::Range(0, 1 << 20))
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback(
      [=, &stop, &chosen] { chosen = [=, &stop] { return record(*common, *options, stop); }; });
}

}  // namespace

void add_record(CLI::App& app, StopSignal& stop, Verb& chosen) {
  add_recording_verb(app, "record", "Records topics into an MCAP file", stop, chosen, {});
  add_recording_verb(
      app, "capture",
      "Records what passes between the computer, the lidar and the stepper, byte for byte: for "
      "a bug report, and for swivel-bench --replay-capture",
      stop, chosen, topics_of_a_capture());
}

}  // namespace swivel
