// swivel replay: a recording in place of the hardware, on the same topics.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

#include "components/common/program.hpp"
#include "components/log/log.hpp"
#include "components/mcap/reader.hpp"
#include "components/recording/mcap_recording.hpp"
#include "components/swivel/offline/offline_pipeline.hpp"
#include "components/swivel/recorder/player.hpp"
#include "components/swivel/recorder/repetition.hpp"
#include "components/swivel/recorder/topics_named.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct ReplayOptions {
  std::string recording;
  double rate = 1.0;
  bool as_fast_as_possible = false;
  bool loop = false;
  double wait_s = 10.0;
  TimeWindow window;
  std::vector<std::string> topics;
};

// A recording of either kind, which can be played again.
struct Replay {
  std::string rig;
  std::vector<AnyTopic> topics;
  std::function<ReplaySource()> open;
};

std::vector<std::string> full_names(const std::vector<AnyTopic>& topics, const std::string& rig) {
  std::vector<std::string> names;
  names.reserve(topics.size());
  for (const AnyTopic& topic : topics) names.push_back(topic.full_name(rig));
  return names;
}

Replay replay_of_mcap(const ReplayOptions& options) {
  const auto rig = rig_in_mcap(options.recording);
  if (!rig) throw ExitError(kExitBadData, rig.reason());
  if (options.topics.empty()) {
    return {*rig, topics_named({"scan_line", "axis", "sweep", "calibration"}, *rig),
            [options] { return play_mcap(options.recording, {}, options.window); }};
  }
  const auto topics = topics_named(options.topics, *rig);
  return {*rig, topics, [options, names = full_names(topics, *rig)] {
            return play_mcap(options.recording, names, options.window);
          }};
}

Replay replay_of_case(const ReplayOptions& options, const std::string& rig_file) {
  const Recording recording = open_recording(options.recording);
  const RigFile rig = rig_of(recording.facts(), options.recording, rig_file);
  return {rig.rig, topics_named({"scan_line", "axis", "sweep"}, rig.rig),
          [options, name = rig.rig] {
            auto again = Recording::open(options.recording, name);
            if (!again) throw ExitError(kExitBadData, again.reason());
            return play_case(std::move(*again));
          }};
}

void await_readers(const Player& player, double patience_s, StopSignal& stop) {
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (!player.has_readers() && !stop.received()) {
    if (steady_clock::now() > deadline) {
      throw ExitError(kExitUnavailable,
                      "nobody listens to what is replayed; start: swivel up --role workstation");
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
    const double time_s = static_cast<double>(time_ns) * 1e-9;
    if (!begun_) first_s_ = time_s;
    begun_ = true;
    // A damaged recording may say any time.
    const std::chrono::duration<double> passed(std::min((time_s - first_s_) / rate_, kLongest_s));
    const auto due = start_ + std::chrono::duration_cast<steady_clock::duration>(passed);
    const auto left = std::chrono::ceil<milliseconds>(due - steady_clock::now());
    if (left > milliseconds(10000)) log_info("nothing for {} s", left.count() / 1000);
    if (left.count() > 0) stop.wait_for(left);
  }

 private:
  static constexpr double kLongest_s = 1e7;
  double rate_;
  bool at_once_;
  bool begun_ = false;
  double first_s_ = 0.0;
  steady_clock::time_point start_ = steady_clock::now();
};

void play(const ReplaySource& source, const ReplayOptions& options, Repetition& repetition,
          Player& player, StopSignal& stop) {
  repetition.begin_round();
  Pace pace(options.rate, options.as_fast_as_possible);
  while (!stop.received()) {
    const auto message = source();
    if (!message) {
      player.finish();
      throw ExitError(kExitBadData, message.reason());
    }
    if (!message->has_value()) break;
    pace.await((*message)->time_ns, stop);
    player.play(options.loop ? repetition.next(**message) : **message);
  }
  player.finish();
}

int replay(const CommonOptions& common, bool rig_given, const ReplayOptions& options,
           StopSignal& stop) {
  start_log("swivel", common.log_level);
  const Replay replay = is_mcap(options.recording)
                            ? replay_of_mcap(options)
                            : replay_of_case(options, rig_given ? common.rig_file : "");
  Participant participant(common.participant("swivel_replay", replay.rig));
  Player player(participant, replay.topics);
  participant.start();
  await_readers(player, options.wait_s, stop);
  Repetition repetition;
  do {
    play(replay.open(), options, repetition, player, stop);
  } while (options.loop && !stop.received());
  participant.stop();
  std::cout << player.in_words() << std::endl;
  return player.played() > 0 ? kExitOk : kExitBadData;
}

}  // namespace

void add_replay(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("replay", "Publishes a recording in place of the hardware");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<ReplayOptions>();
  verb->add_option("recording", options->recording,
                   "An .mcap file, a .csv.gz recording, or a case folder")
      ->required();
  verb->add_option("--rate", options->rate, "Times real time")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  verb->add_flag("--max", options->as_fast_as_possible, "As fast as the readers can follow");
  verb->add_flag("--loop", options->loop,
                 "Again and again until stopped, each time as sweeps of their own");
  verb->add_option("--from", options->window.from_s, "Of an .mcap file: from so many seconds on");
  verb->add_option("--to", options->window.to_s, "Of an .mcap file: up to so many seconds");
  verb->add_option("--topics", options->topics,
                   "Of an .mcap file: these as they are. Else what the hardware sent, and the "
                   "calibration; the stages make the rest again");
  verb->add_option("--wait-s", options->wait_s, "How long to wait for readers")
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    const bool rig_given = verb->count("--rig") > 0;
    chosen = [=, &stop] { return replay(*common, rig_given, *options, stop); };
  });
}

}  // namespace swivel
