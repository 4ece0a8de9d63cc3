// swivel map RECORDING|live -o DIR: pictures of the sweeps, of a recording or of what the rig
// scans, whoever asked for it.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <deque>
#include <iostream>
#include <memory>

#include "components/common/program.hpp"
#include "components/swivel/live/live_sweeps.hpp"
#include "components/swivel/report/sweep_pictures.hpp"
#include "components/swivel/source_options.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

constexpr auto kHintAfter = std::chrono::seconds(5);
constexpr auto kMoreComesWithin = std::chrono::milliseconds(500);

struct MapOptions {
  RecordedRunOptions source;
  int count = 1;  // live
};

nlohmann::ordered_json draw(SweepPictures& pictures, const ProcessedSweep& processed) {
  if (!processed.cloud.points.empty()) pictures.draw(processed, pictures.surfaces_of(processed));
  return {};
}

int map_recording(const MapOptions& options) {
  RecordedRun run(options.source);
  SweepPictures pictures(options.source.folder, run.title(), run.rig());
  run.run([&](const ProcessedSweep& processed) { return draw(pictures, processed); });
  run.output().finish();
  return run.exit_code();
}

// The last sweeps are told to whoever begins to listen, one after the other, and then those that
// come.
void draw_what_comes(LiveSweeps& sweeps, std::size_t count, OutputFolder& output,
                     SweepPictures& pictures, StopSignal& stop) {
  const auto start = std::chrono::steady_clock::now();
  std::deque<ProcessedSweep> told;
  bool hinted = false;
  while (output.sweeps() < count && !stop.received()) {
    auto news = sweeps.wait(kMoreComesWithin);
    if (news && news->sweep && !news->sweep->cloud.points.empty())
      told.push_back(std::move(*news->sweep));
    if (told.size() > count - output.sweeps()) told.pop_front();
    if (news) continue;
    for (ProcessedSweep& sweep : told) {
      sweep.index = output.sweeps();
      output.add(sweep, draw(pictures, sweep));
    }
    told.clear();
    if (hinted || output.sweeps() > 0 || std::chrono::steady_clock::now() < start + kHintAfter)
      continue;
    std::cerr << "no sweep yet; is the rig up? see: swivel status; ask for a sweep with: swivel "
                 "scan, or on the page of swivel view\n";
    hinted = true;
  }
}

int map_live(const CommonOptions& common, const MapOptions& options, StopSignal& stop) {
  const RigFile rig = begin_live(common, options.source);
  OutputFolder output(options.source.folder, rig.rig, rig, options.source.kinds);
  SweepPictures pictures(options.source.folder, rig.rig, rig);
  Participant participant(common.participant("swivel_map", rig.rig));
  LiveSweeps sweeps(participant);
  sweeps.follow_all();
  participant.start();
  draw_what_comes(sweeps, static_cast<std::size_t>(options.count), output, pictures, stop);
  participant.stop();
  if (output.sweeps() == 0) throw ExitError(kExitTryAgain, "stopped before any sweep came");
  output.finish();
  return kExitOk;
}

}  // namespace

void add_map(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("map", "Pictures of the sweeps of a recording, or of a live rig");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<MapOptions>();
  options->source.kinds.no_clouds = true;
  add_source_options(*verb, options->source, true);
  verb->add_option("--count", options->count, "Live: how many sweeps, the last one counted")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  add_common_options(*verb, *common);
  verb->callback([=, &stop, &chosen] {
    options->source.rig_file = asked_rig_file(*verb, *common);
    chosen = [=, &stop] {
      return options->source.recording == kLive ? map_live(*common, *options, stop)
                                                : map_recording(*options);
    };
  });
}

}  // namespace swivel
