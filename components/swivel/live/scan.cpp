#include "components/swivel/live/scan.hpp"

#include <unistd.h>

#include <iostream>

#include "components/attitude_corrector/corrector.hpp"
#include "components/common/roll.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

// Of homing, or of one sweep of the slowest mode with its way there and back.
constexpr auto kSilenceOfAScan = std::chrono::seconds(90);

// Of those who start, and home.
constexpr auto kStartAndHoming = std::chrono::seconds(30);

// Of another's sweep that is just returning.
constexpr auto kBusy = std::chrono::seconds(20);

// One line that is written over, on a terminal only.
void show_progress(const std::string& words, int done, int count) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::cerr << "\r\033[K" << done << " of " << count << ": " << words << std::flush;
}

void clear_progress() {
  if (isatty(STDERR_FILENO) != 0) std::cerr << "\r\033[K" << std::flush;
}

bool is_good(const ProcessedSweep& sweep) {
  return sweep.sweep.complete() && Corrector::in_base(sweep.attitude.verdict());
}

}  // namespace

void check_mode(const RigFile& rig, int mode) {
  if (rig.modes.lines.count(mode) != 0) return;
  std::string known;
  for (const auto& [number, lines] : rig.modes.lines) known += " " + std::to_string(number);
  throw ExitError(kExitUsage,
                  "mode " + std::to_string(mode) + " is not one of this rig's:" + known);
}

int scan(LiveSweeps& sweeps, const ScanOptions& options, OutputFolder& output, StopSignal& stop,
         const Remark& remark) {
  if (!sweeps.await_idle(kBusy)) {
    throw ExitError(kExitTryAgain, "the sequencer is busy with another request; try again later");
  }
  sweeps.request(options.mode, options.count, options.action_sequence);
  int done = 0;
  int good = 0;
  auto last_news = steady_clock::now();
  while (done < options.count) {
    if (stop.received()) {
      sweeps.cancel();
      throw ExitError(kExitTryAgain, "stopped; the sweep was cancelled");
    }
    auto news = sweeps.wait(std::chrono::milliseconds(100));
    if (!news && steady_clock::now() - last_news > kSilenceOfAScan) {
      throw ExitError(kExitUnavailable, "no news of the sweep for 90 s; see: swivel status");
    }
    if (!news) continue;
    last_news = steady_clock::now();
    if (!news->refusal.empty()) throw ExitError(kExitUnavailable, news->refusal);
    if (!news->progress.empty()) show_progress(news->progress, done, options.count);
    if (!news->sweep) continue;
    clear_progress();
    output.add(*news->sweep, remark ? remark(*news->sweep) : nlohmann::ordered_json());
    good += is_good(*news->sweep) ? 1 : 0;
    ++done;
  }
  return good;
}

int scan_live(const ParticipantOptions& options_of_participant, const ScanOptions& options,
              OutputFolder& output, StopSignal& stop, const Remark& remark) {
  Participant participant(options_of_participant);
  const Roll roll(participant);
  LiveSweeps sweeps(participant);
  participant.start();
  const std::string missing =
      roll.await({"stepper_sequencer", "hokuyo_reader", "cloud_assembler", "attitude_corrector"},
                 kStartAndHoming);
  if (!missing.empty()) throw ExitError(kExitUnavailable, missing + "; start them with: swivel up");
  return scan(sweeps, options, output, stop, remark);
}

}  // namespace swivel
