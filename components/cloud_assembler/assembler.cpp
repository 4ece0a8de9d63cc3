#include "components/cloud_assembler/assembler.hpp"

#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

using std::chrono::steady_clock;

// Bounds on what any writer may make us hold.
constexpr std::size_t kMostWaitingLines = 400;
constexpr std::uint32_t kMostLines = 20000;
constexpr std::size_t kMostBeams = 10000;
constexpr std::int64_t kAxisMemory_ns = 60'000'000'000;

// A line on its way may be this late against the sequencer's word that the sweep is over.
constexpr auto kGraceAfterSweep = std::chrono::seconds(1);
constexpr auto kSilence = std::chrono::seconds(5);

bool well_formed(const msg::ScanLine& line) {
  const std::size_t beams = line.ranges_mm().size();
  const bool intensities_fit = line.intensities().empty() || line.intensities().size() == beams;
  return beams > 0 && beams <= kMostBeams && intensities_fit &&
         std::isfinite(line.first_beam_angle_deg()) && std::isfinite(line.beam_step_deg()) &&
         line.beam_period_ns() > 0.0 && line.scan_period_ns() < 1e10 &&
         line.beam_period_ns() * static_cast<double>(beams - 1) < line.scan_period_ns() &&
         line.beam0_time_ns() > 0;
}

bool well_formed_window(const msg::Sweep& sweep) {
  return sweep.lines_expected() > 0 && sweep.lines_expected() <= kMostLines &&
         sweep.window_lines() > 0 && sweep.window_start_ns() < sweep.window_end_ns() &&
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
  news_ = true;
  if (!well_formed(line)) {
    ++counters_.lines_rejected;
    return;
  }
  if (belongs_to_last_closed(line)) {
    ++counters_.lines_late;
    return;
  }
  if (!waiting_.empty() && line.beam0_time_ns() <= waiting_.back().beam0_time_ns()) {
    // The lidar's clock was set anew, or another reader took over.
    counters_.lines_outside += waiting_.size();
    waiting_.clear();
  }
  waiting_.push_back(line);
  place_lines();
  forget_old_lines();
}

void Assembler::add(const msg::Axis& axis) {
  for (const msg::AxisSample& sample : axis.samples()) {
    if (axis_.add({sample.time_ns(), rad_from_deg(sample.angle_deg())}) != AxisAdded::kAdded) {
      ++counters_.axis_samples_rejected;
    }
  }
  if (!axis.samples().empty())
    axis_.forget_before(axis.samples().back().time_ns() - kAxisMemory_ns);
  place_lines();
}

void Assembler::add(const msg::Sweep& sweep) {
  news_ = true;
  if (sweep.phase() == msg::PHASE_CRUISING) {
    begin_or_extend(sweep);
  } else if (sweep.phase() == msg::PHASE_FAULT) {
    abandon(sweep);
  } else if (sweep_ && ends_sweep(sweep.phase())) {
    ending_ = true;
  }
  place_lines();
}

void Assembler::begin_or_extend(const msg::Sweep& sweep) {
  if (!well_formed_window(sweep)) return;
  if (sweep_ && sweep_->id() == sweep.sweep_id()) return sweep_->add_window(sweep);
  if (sweep_) close("the next sweep began before the last line was in");
  if (sweep.sweep_id() == last_closed_.sweep_id()) return;  // told again to a late reader
  sweep_ = std::make_unique<SweepInProgress>(options_, sweep);
  ending_ = false;
}

// The shaft may have stood still for some time before the fault was seen: no line of the sweep
// can be trusted, not even when all of them are in.
void Assembler::abandon(const msg::Sweep& fault) {
  const bool just_closed = !sweep_ && fault.sweep_id() != 0 &&
                           fault.sweep_id() == last_closed_.sweep_id() && last_closed_.complete();
  if (!just_closed && (!sweep_ || (fault.sweep_id() != 0 && fault.sweep_id() != sweep_->id())))
    return;
  msg::Sweep summary = just_closed ? last_closed_ : sweep_->summary("");
  summary.complete(false);
  summary.lines_used(0);
  summary.lines_missing(summary.lines_expected());
  summary.reason("motor fault, do not use: " + fault.reason());
  sweep_.reset();
  last_closed_ = summary;
  ++counters_.sweeps_incomplete;
  on_sweep_({summary, {}});
}

bool Assembler::angles_known(const msg::ScanLine& line) const {
  return options_.timing == Timing::kEq7 ||
         axis_.covers(line.beam0_time_ns(), last_beam_time_ns(line));
}

void Assembler::place_lines() {
  while (sweep_ && !waiting_.empty() && !sweep_->waits_for_window()) {
    if (sweep_->spans(waiting_.front()) && !angles_known(waiting_.front())) return;
    place(waiting_.front());
    waiting_.pop_front();
    if (sweep_->last_line_is_in()) close("");
  }
}

void Assembler::place(const msg::ScanLine& line) {
  switch (sweep_->place(line, axis_)) {
    case SweepInProgress::Fate::kPlaced:
      ++counters_.lines_used;
      break;
    case SweepInProgress::Fate::kOtherShape:
      ++counters_.lines_rejected;
      break;
    case SweepInProgress::Fate::kBeforeWindow:
    case SweepInProgress::Fate::kBeyondWindow:
      ++counters_.lines_outside;
      break;
  }
}

void Assembler::close(const std::string& reason) {
  msg::Sweep summary = sweep_->summary(reason);
  if (!summary.complete()) {
    summary.reason(std::to_string(summary.lines_missing()) + " of " +
                   std::to_string(summary.lines_expected()) + " lines missing" +
                   (reason.empty() ? "" : ": " + reason));
  }
  ++(summary.complete() ? counters_.sweeps_complete : counters_.sweeps_incomplete);
  counters_.lines_missing += summary.lines_missing();
  OrganisedCloud cloud = sweep_->take_cloud();
  sweep_.reset();
  last_closed_ = summary;
  on_sweep_({std::move(summary), std::move(cloud)});
}

void Assembler::check(steady_clock::time_point now) {
  if (news_) last_news_ = now;
  news_ = false;
  if (!ending_) ending_since_ = now;
  if (!sweep_) return;
  if (ending_ && now - ending_since_ > kGraceAfterSweep) {
    close(
        "the sweep is over and they did not come; is the lidar connected, does hokuyo_reader run?");
  } else if (now - last_news_ > kSilence) {
    close("neither lidar nor sequencer has been heard for 5 s");
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
