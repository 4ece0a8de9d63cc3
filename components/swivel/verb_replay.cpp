// swivel replay: a recording in place of the hardware, on the same topics.
#include <spdlog/spdlog.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <atomic>
#include <iostream>
#include <memory>
#include <set>

#include "components/common/program.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/verbs.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct ReplayOptions {
  std::string recording;
  double rate = 1.0;
  bool as_fast_as_possible = false;
  double wait_s = 10.0;
};

// Less than the writer's history: what is not yet acknowledged must not be overwritten.
constexpr std::uint64_t kLinesUnacknowledged = 100;
constexpr auto kAcknowledged = milliseconds(5000);

// Publishes a recording's events, as fast as the readers can follow.
class Player {
 public:
  explicit Player(Participant& participant)
      : lines_(participant, kScanLineTopic),
        axis_(participant, kAxisTopic),
        sweeps_(participant, kSweepTopic) {
    participant.subscribe<msg::Sweep>(kSweepTopic, [this](const msg::Sweep& sweep) {
      if (sweep.phase() == msg::PHASE_ASSEMBLED) last_assembled_ = sweep.sweep_id();
    });
  }

  bool has_readers() const { return lines_.reader_count() > 0 && sweeps_.reader_count() > 1; }

  void play(const RecordedEvent& event) {
    std::visit([this](const auto& message) { write(message); }, event.message);
  }

  // After the last line of a sweep: no faster than it is assembled.
  void await_assembled() {
    if (sweep_ == 0) return;
    const auto deadline = steady_clock::now() + kAcknowledged;
    while (last_assembled_ != sweep_ && steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    sweep_ = 0;
  }

  void finish() {
    lines_.wait_until_acknowledged(kAcknowledged);
    axis_.wait_until_acknowledged(kAcknowledged);
    sweeps_.wait_until_acknowledged(kAcknowledged);
    std::cout << lines_.written() << " lines, " << axis_.written() << " axis messages, "
              << sweeps_.written() << " sweep messages replayed" << std::endl;
  }

 private:
  void write(const msg::ScanLine& line) {
    lines_.write(msg::ScanLine(line));
    if (lines_.written() % kLinesUnacknowledged == 0) lines_.wait_until_acknowledged(kAcknowledged);
  }
  void write(const msg::Axis& axis) {
    axis_.write(msg::Axis(axis));
    axis_.wait_until_acknowledged(kAcknowledged);
  }
  void write(const msg::Sweep& sweep) {
    sweeps_.write(msg::Sweep(sweep));
    sweeps_.wait_until_acknowledged(kAcknowledged);
    if (sweep.phase() == msg::PHASE_CRUISING) sweep_ = sweep.sweep_id();
    if (sweep.phase() == msg::PHASE_DECELERATING) await_assembled();
  }

  Writer<msg::ScanLine> lines_;
  Writer<msg::Axis> axis_;
  Writer<msg::Sweep> sweeps_;
  std::uint64_t sweep_ = 0;  // under way
  std::atomic<std::uint64_t> last_assembled_{0};
};

void await_readers(const Player& player, double patience_s, StopSignal& stop) {
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (!player.has_readers() && !stop.received()) {
    if (steady_clock::now() > deadline) {
      throw ExitError(kExitUnavailable,
                      "nobody listens to the scan lines; start: swivel up --role workstation");
    }
    stop.wait_for(milliseconds(10));
  }
}

// Times of the recording to those of now: what is replayed happens now.
class Pace {
 public:
  Pace(double rate, bool as_fast_as_possible) : rate_(rate), at_once_(as_fast_as_possible) {}

  void await(std::int64_t time_ns, StopSignal& stop) {
    if (at_once_) return;
    if (first_ns_ == 0) first_ns_ = time_ns;
    const std::chrono::duration<double> passed(static_cast<double>(time_ns - first_ns_) * 1e-9 /
                                               rate_);
    const auto due = start_ + std::chrono::duration_cast<steady_clock::duration>(passed);
    const auto left = std::chrono::ceil<milliseconds>(due - steady_clock::now());
    if (left.count() > 0) stop.wait_for(left);
  }

 private:
  double rate_;
  bool at_once_;
  std::int64_t first_ns_ = 0;
  steady_clock::time_point start_ = steady_clock::now();
};

int replay(const CommonOptions& common, bool rig_given, const ReplayOptions& options,
           StopSignal& stop) {
  start_log("swivel", common.log_level);
  Recording recording = open_recording(options.recording);
  const RigFile rig =
      rig_of(recording.facts(), options.recording, rig_given ? common.rig_file : "");
  Participant participant(common.participant("swivel_replay", rig.rig));
  Player player(participant);
  participant.start();
  await_readers(player, options.wait_s, stop);
  Pace pace(options.rate, options.as_fast_as_possible);
  while (!stop.received()) {
    const auto event = recording.next();
    if (!event) throw ExitError(kExitBadData, event.reason());
    if (!event->has_value()) break;
    pace.await((*event)->time_ns, stop);
    player.play(**event);
  }
  player.finish();
  return kExitOk;
}

}  // namespace

void add_replay(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("replay", "Publishes a recording in place of the hardware");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<ReplayOptions>();
  verb->add_option("recording", options->recording, "A .csv.gz recording, or a case folder")
      ->required();
  verb->add_option("--rate", options->rate, "Times real time")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  verb->add_flag("--max", options->as_fast_as_possible, "As fast as the readers can follow");
  verb->add_option("--wait-s", options->wait_s, "How long to wait for readers")
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    const bool rig_given = verb->count("--rig") > 0;
    chosen = [=, &stop] { return replay(*common, rig_given, *options, stop); };
  });
}

}  // namespace swivel
