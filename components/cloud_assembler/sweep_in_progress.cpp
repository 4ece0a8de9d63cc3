#include "components/cloud_assembler/sweep_in_progress.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace swivel {
namespace {

constexpr std::size_t kMostPoints = 1U << 24;  // 256 MiB, 24 times a cloud of mode 7

}  // namespace

std::int64_t last_beam_time_ns(const msg::ScanLine& line) {
  const double beams = static_cast<double>(line.ranges_mm().size());
  return line.beam0_time_ns() + std::llround((beams - 1.0) * line.beam_period_ns());
}

SweepInProgress::SweepInProgress(const AssemblyOptions& options, const msg::Sweep& sweep)
    : options_(options),
      announced_(sweep),
      lines_expected_(sweep.lines_expected()),
      last_end_ns_(sweep.window_start_ns()) {
  add_window(sweep);
}

bool SweepInProgress::add_window(const msg::Sweep& sweep) {
  if (sweep.window_start_ns() < last_end_ns_ || sweep.window_first_line() < rows_announced_ ||
      sweep.lines_expected() != lines_expected_) {
    return false;
  }
  windows_.push_back({sweep.window_start_ns(), sweep.window_end_ns(), sweep.window_first_line(),
                      sweep.window_lines()});
  last_end_ns_ = sweep.window_end_ns();
  rows_announced_ = windows_.back().first_row + windows_.back().rows;
  return true;
}

void SweepInProgress::leave_windows_before(const msg::ScanLine& line) {
  while (!windows_.empty() && last_beam_time_ns(line) > windows_.front().end_ns) leave_window();
}

void SweepInProgress::leave_window() {
  windows_.erase(windows_.begin());
  previous_in_window_ = false;
}

bool SweepInProgress::takes(const msg::ScanLine& line) const {
  return !windows_.empty() && line.beam0_time_ns() >= windows_.front().start_ns &&
         last_beam_time_ns(line) <= windows_.front().end_ns;
}

bool SweepInProgress::fits(const msg::ScanLine& line) const {
  return line.ranges_mm().size() == cloud_.beams &&
         line.first_beam_angle_deg() == first_line_.first_beam_angle_deg() &&
         line.beam_step_deg() == first_line_.beam_step_deg();
}

SweepInProgress::Fate SweepInProgress::place(const msg::ScanLine& line, const AxisTrack& axis) {
  assert(!windows_.empty());
  if (line.beam0_time_ns() < windows_.front().start_ns) return Fate::kBeforeWindow;
  if (!assembler_ && !begin(line, axis)) return Fate::kRefused;
  const std::optional<std::size_t> row = row_of(line);
  if (!fits(line) || !row) return Fate::kRefused;

  const std::size_t end_row = windows_.front().first_row + windows_.front().rows;
  const bool inside = *row < end_row;
  if (inside) write_row(*row, line, axis);
  if (inside && options_.keep_readings) keep_line(line, axis);
  previous_row_ = *row;
  previous_time_ns_ = line.beam0_time_ns();
  previous_in_window_ = true;
  if (*row + 1 >= end_row) leave_window();
  return inside ? Fate::kPlaced : Fate::kBeyondWindow;
}

// Counted from the line before, so that an error of the period does not add up. None for a line
// that came twice, or a clock that was set back.
std::optional<std::size_t> SweepInProgress::row_of(const msg::ScanLine& line) const {
  if (!previous_in_window_) return windows_.front().first_row;
  const double periods =
      static_cast<double>(line.beam0_time_ns() - previous_time_ns_) / line.scan_period_ns();
  if (periods < 0.5) return std::nullopt;
  return previous_row_ + static_cast<std::size_t>(std::llround(periods));
}

bool SweepInProgress::begin(const msg::ScanLine& line, const AxisTrack& axis) {
  if (lines_expected_ * line.ranges_mm().size() > kMostPoints) return false;
  assembler_.emplace(ForwardModel(options_.geometry, rad_from_deg(line.first_beam_angle_deg()),
                                  rad_from_deg(line.beam_step_deg()), line.ranges_mm().size()));
  cloud_ = OrganisedCloud(lines_expected_, line.ranges_mm().size());
  first_line_ = line;
  readings_.first_beam_angle_rad = rad_from_deg(line.first_beam_angle_deg());
  readings_.beam_step_rad = rad_from_deg(line.beam_step_deg());
  if (options_.axis_measured) return true;
  const bool first_row = windows_.front().first_row == 0;
  const std::int64_t origin_ns = first_row ? line.beam0_time_ns() : announced_.window_start_ns();
  first_angle_rad_ = axis.angle_at(origin_ns).value_or(0.0);
  return true;
}

// The direction is the sweep's: a line of a stop-and-go sweep stands still.
bool SweepInProgress::turns_down() const {
  return announced_.speed_deg_s() < 0.0;
}

void SweepInProgress::write_row(std::size_t row, const msg::ScanLine& line, const AxisTrack& axis) {
  const double behind_rad = turns_down() ? options_.geometry.hysteresis_rad : 0.0;
  const double zero_rad = first_angle_rad_ - behind_rad;
  const LineReadings readings{line.ranges_mm(), line.intensities(), line.range_min_mm(),
                              line.range_max_mm()};
  if (options_.timing == Timing::kEq7) {
    const double per_line_rad = options_.sweep_angle_rad / static_cast<double>(lines_expected_);
    assembler_->assemble(readings, static_cast<double>(row) * per_line_rad,
                         per_line_rad / static_cast<double>(cloud_.beams), cloud_.line(row));
  } else if (const auto segment =
                 axis.segment_over(line.beam0_time_ns(), last_beam_time_ns(line))) {
    assembler_->assemble(readings, segment->start_angle_rad - zero_rad,
                         segment->rate_rad_s * s_from_ns(line.beam_period_ns()), cloud_.line(row));
  } else {
    std::vector<double> angles_rad(cloud_.beams);
    for (std::size_t beam = 0; beam < cloud_.beams; ++beam) {
      const double delay_ns = static_cast<double>(beam) * line.beam_period_ns();
      angles_rad[beam] =
          axis.angle_at(line.beam0_time_ns() + std::llround(delay_ns)).value() - zero_rad;
    }
    assembler_->assemble(readings, angles_rad, cloud_.line(row));
  }
  ++lines_used_;
}

void SweepInProgress::keep_line(const msg::ScanLine& line, const AxisTrack& axis) {
  const auto first_rad = axis.angle_at(line.beam0_time_ns());
  const auto last_rad = axis.angle_at(last_beam_time_ns(line));
  if (!first_rad || !last_rad) return;
  const std::size_t beams = line.ranges_mm().size();
  LineOfReadings kept;
  kept.axis_angle_rad = *first_rad - first_angle_rad_;
  kept.angle_per_beam_rad =
      (*last_rad - *first_rad) / static_cast<double>(std::max<std::size_t>(1, beams - 1));
  kept.turning_down = turns_down();
  kept.ranges_m.reserve(beams);
  for (const std::uint16_t range_mm : line.ranges_mm()) {
    const bool valid = range_mm >= line.range_min_mm() && range_mm <= line.range_max_mm();
    kept.ranges_m.push_back(valid ? static_cast<float>(m_from_mm(range_mm))
                                  : std::numeric_limits<float>::quiet_NaN());
  }
  readings_.lines.push_back(std::move(kept));
}

msg::Sweep SweepInProgress::summary(const std::string& reason) const {
  msg::Sweep summary = announced_;
  summary.phase(msg::PHASE_ASSEMBLED);
  summary.window_end_ns(last_end_ns_);
  summary.first_beam_time_ns(first_line_.beam0_time_ns());
  summary.first_device_stamp_ms(first_line_.device_stamp_ms());
  summary.lines_used(static_cast<std::uint32_t>(lines_used_));
  summary.lines_missing(static_cast<std::uint32_t>(lines_expected_ - lines_used_));
  summary.complete(lines_used_ == lines_expected_);
  summary.reason(reason);
  return summary;
}

}  // namespace swivel
