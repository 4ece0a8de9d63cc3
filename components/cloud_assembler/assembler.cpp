#include "components/cloud_assembler/assembler.hpp"

#include <algorithm>
#include <cmath>

#include "components/dds/bounds.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

// Bounds on what any writer may make us hold.
constexpr std::size_t kMostWaitingLines = 400;
constexpr double kShortestScanNs = 1e5;
constexpr std::int64_t kLatestNs = 2'147'483'647'000'000'000;  // what a cloud's stamp can hold
constexpr std::int64_t kAxisMemoryNs = 60'000'000'000;

// A line on its way may be this late against the sequencer's word that the sweep is over.
constexpr auto kGraceAfterSweep = std::chrono::seconds(1);
constexpr auto kSilence = std::chrono::seconds(5);
constexpr auto kHistoryComesWithin = std::chrono::seconds(2);

bool well_formed(const msg::ScanLine& line) {
  const std::size_t beams = line.ranges_mm().size();
  const bool intensities_fit = line.intensities().empty() || line.intensities().size() == beams;
  return beams > 0 && beams <= kMostBeamsOfALine && intensities_fit &&
         std::isfinite(line.first_beam_angle_deg()) && std::isfinite(line.beam_step_deg()) &&
         line.beam_period_ns() > 0.0 && line.scan_period_ns() < 1e10 &&
         line.scan_period_ns() > kShortestScanNs &&
         line.beam_period_ns() * static_cast<double>(beams - 1) < line.scan_period_ns() &&
         line.beam0_time_ns() > 0 && line.beam0_time_ns() < kLatestNs;
}

bool well_formed_window(const msg::Sweep& sweep) {
  return sweep.sweep_id() != 0 && sweep.lines_expected() > 0 &&
         sweep.lines_expected() <= kMostLinesOfASweep && sweep.window_lines() > 0 &&
         sweep.window_start_ns() < sweep.window_end_ns() &&
         sweep.window_first_line() < sweep.lines_expected() &&
         sweep.window_lines() <= sweep.lines_expected() - sweep.window_first_line();
}

bool ends_sweep(msg::SweepPhase phase) {
  return phase == msg::PHASE_DECELERATING || phase == msg::PHASE_RETURNING ||
         phase == msg::PHASE_IDLE;
}

}  // namespace

Assembler::Assembler(const AssemblyOptions& options, std::function<void(AssembledSweep&&)> on_sweep)
    : options_(options), on_sweep_(std::move(on_sweep)) {}

void Assembler::add(const msg::ScanLine& line) {
  ++counters_.lines_received;
  if (!well_formed(line)) {
    ++counters_.lines_rejected;
    return;
  }
  if (belongs_to_last_closed(line)) {
    ++counters_.lines_late;
    return;
  }
  if (!waiting_.empty() && line.beam0_time_ns() == waiting_.back().beam0_time_ns()) {
    ++counters_.lines_rejected;
    return;
  }
  if (!waiting_.empty() && line.beam0_time_ns() < waiting_.back().beam0_time_ns()) {
    // The lidar's clock was set anew, or another reader took over.
    counters_.lines_outside += waiting_.size();
    waiting_.clear();
  }
  if (first_line_ns_ == 0) first_line_ns_ = line.beam0_time_ns();
  waiting_.push_back(line);
  place_lines();
  forget_old_lines();
}

void Assembler::add(const msg::Axis& axis) {
  if (axis.samples().empty()) return;
  if ((axis.source() == msg::AXIS_MEASURED) != options_.axis_measured) {
    counters_.axis_samples_rejected += axis.samples().size();
    return;
  }
  // A commanded turn that was cancelled had been told to its end; and over a lost message the
  // track must not run straight. In both cases only what comes now is true.
  const bool goes_back = axis.samples().front().time_ns() < last_axis_ns_;
  const bool lost = last_axis_number_ != 0 && axis.sequence_number() > last_axis_number_ + 1;
  if (goes_back || lost) axis_ = AxisTrack();
  last_axis_number_ = axis.sequence_number();
  for (const msg::AxisSample& sample : axis.samples()) add(sample);
  if (last_axis_ns_ > kAxisMemoryNs) axis_.forget_before(last_axis_ns_ - kAxisMemoryNs);
  place_lines();
}

void Assembler::add(const msg::AxisSample& sample) {
  const bool added =
      axis_.add({sample.time_ns(), rad_from_deg(sample.angle_deg())}) == AxisAdded::kAdded;
  if (added) last_axis_ns_ = sample.time_ns();
  if (!added) ++counters_.axis_samples_rejected;
}

void Assembler::add(const msg::Sweep& sweep) {
  news_ = true;
  if (sweep.phase() == msg::PHASE_CRUISING) {
    begin_or_extend(sweep);
  } else if (sweep.phase() == msg::PHASE_FAULT) {
    abandon(sweep, "motor fault, do not use: " + sweep.reason());
  } else if (ends_sweep(sweep.phase())) {
    end(sweep);
  }
  place_lines();
}

void Assembler::begin_or_extend(const msg::Sweep& sweep) {
  const bool well = well_formed_window(sweep);
  const bool first = sweep.window_first_line() == 0;
  if (well && sweep_ && !first && sweep.sweep_id() == sweep_->announced().sweep_id()) {
    if (!sweep_->add_window(sweep)) ++counters_.windows_rejected;
  } else if (!well) {
    ++counters_.windows_rejected;
  } else if (!told_before(sweep)) {
    begin(sweep);
  }
}

// As to a reader that was lost and found again.
bool Assembler::told_before(const msg::Sweep& sweep) const {
  const msg::Sweep& last = sweep_ ? sweep_->announced() : last_closed_;
  return sweep.sweep_id() == last.sweep_id() &&
         (sweep.window_first_line() != 0 || sweep.window_start_ns() == last.window_start_ns());
}

void Assembler::begin(const msg::Sweep& sweep) {
  if (sweep_ && told_at_start_ && first_line_ns_ == 0) {
    ++counters_.sweeps_before_start;
  } else if (sweep_) {
    close("the next sweep began before the last line was in");
  }
  sweep_ = std::make_unique<SweepInProgress>(options_, sweep);
  ending_ = false;
  told_at_start_ = start_ && last_check_ - *start_ < kHistoryComesWithin;
}

// A reason says that the turn ended early. After the window was left without one, it is told of
// what comes after the sweep.
void Assembler::end(const msg::Sweep& sweep) {
  const bool cut_short = !sweep.reason().empty() && !ending_;
  if (!cut_short) {
    ending_ = true;
  } else if (sweep_ || sweep.time_ns() < last_used_ns_) {
    abandon(sweep, "ended early, do not use: " + sweep.reason());
  }
}

// The shaft may have stood still for some time before a fault was seen: no line of the sweep
// can be trusted, not even when all of them are in.
void Assembler::abandon(const msg::Sweep& ended, const std::string& why) {
  const bool open =
      sweep_ && (ended.sweep_id() == 0 || ended.sweep_id() == sweep_->announced().sweep_id());
  const bool just_closed = !sweep_ && ended.sweep_id() != 0 &&
                           ended.sweep_id() == last_closed_.sweep_id() && last_closed_.complete();
  if (!open && !just_closed) return;
  msg::Sweep summary = open ? sweep_->summary(why) : last_closed_;
  summary.complete(false);
  summary.lines_used(0);
  summary.lines_missing(summary.lines_expected());
  summary.reason(why);
  sweep_.reset();
  last_closed_ = summary;
  // Later lines may be those of the next sweep.
  last_closed_.window_end_ns(std::min(summary.window_end_ns(), ended.time_ns()));
  ++counters_.sweeps_incomplete;
  on_sweep_({std::move(summary), {}, {}});
}

bool Assembler::lacks_angles() const {
  if (options_.timing == Timing::kEq7 || waiting_.empty()) return false;
  const msg::ScanLine& line = waiting_.front();
  return sweep_->takes(line) && !axis_.covers(line.beam0_time_ns(), last_beam_time_ns(line));
}

void Assembler::place_lines() {
  while (sweep_ && !waiting_.empty()) {
    sweep_->leave_windows_before(waiting_.front());
    if (sweep_->is_over()) return close("");
    if (sweep_->waits_for_window() || lacks_angles()) return;
    place(waiting_.front());
    waiting_.pop_front();
    if (sweep_->is_over()) close("");
  }
}

void Assembler::place(const msg::ScanLine& line) {
  switch (sweep_->place(line, axis_)) {
    case SweepInProgress::Fate::kPlaced:
      ++counters_.lines_used;
      news_ = true;
      last_used_ns_ = last_beam_time_ns(line);
      if (on_row_) on_row_(sweep_->announced(), sweep_->cloud(), sweep_->last_row());
      break;
    case SweepInProgress::Fate::kRefused:
      ++counters_.lines_rejected;
      break;
    case SweepInProgress::Fate::kBeforeWindow:
    case SweepInProgress::Fate::kBeyondWindow:
      ++counters_.lines_outside;
      break;
  }
}

// Who starts late is told of earlier sweeps too. Those whose lines are gone were the affair of
// the assembler before us: to call them incomplete would belie a good cloud.
bool Assembler::was_before_our_time() const {
  return told_at_start_ && sweep_->cloud().points.empty() &&
         first_line_ns_ > sweep_->announced().window_end_ns();
}

void Assembler::close(const std::string& reason) {
  if (was_before_our_time()) {
    ++counters_.sweeps_before_start;
    sweep_.reset();
    return;
  }
  msg::Sweep summary = sweep_->summary(reason);
  if (!summary.complete()) {
    summary.reason(std::to_string(summary.lines_missing()) + " of " +
                   std::to_string(summary.lines_expected()) + " lines missing" +
                   (reason.empty() ? "" : ": " + reason));
  }
  ++(summary.complete() ? counters_.sweeps_complete : counters_.sweeps_incomplete);
  counters_.lines_missing += summary.lines_missing();
  OrganisedCloud cloud = sweep_->take_cloud();
  SweepReadings readings = sweep_->take_readings();
  sweep_.reset();
  last_closed_ = summary;
  on_sweep_({std::move(summary), std::move(cloud), std::move(readings)});
}

void Assembler::check(steady_clock::time_point now) {
  if (!start_) start_ = now;
  last_check_ = now;
  if (news_) last_news_ = now;
  news_ = false;
  if (!ending_) ending_since_ = now;
  if (!sweep_) return;
  if (ending_ && now - ending_since_ > kGraceAfterSweep) {
    close("the sweep is over and " +
          std::string(lacks_angles()
                          ? "their axis angles did not come; does what publishes swivel/axis run?"
                          : "they did not come; is the lidar connected, does hokuyo_reader run?"));
  } else if (now - last_news_ > kSilence) {
    close("for 5 s no line could be used and the sequencer said nothing");
  }
}

void Assembler::finish() {
  if (sweep_) close("the data ended");
}

bool Assembler::belongs_to_last_closed(const msg::ScanLine& line) const {
  return !sweep_ && !last_closed_.complete() &&
         line.beam0_time_ns() >= last_closed_.window_start_ns() &&
         last_beam_time_ns(line) <= last_closed_.window_end_ns();
}

void Assembler::forget_old_lines() {
  while (waiting_.size() > kMostWaitingLines) {
    ++counters_.lines_outside;
    waiting_.pop_front();
  }
}

}  // namespace swivel
