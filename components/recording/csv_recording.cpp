#include "components/recording/csv_recording.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "calibration/units.hpp"
#include "components/recording/csv_rows.hpp"
#include "components/recording/stamp_fit.hpp"

namespace swivel {
namespace {

constexpr std::size_t kMostLinesOfARecording = 1'000'000;
constexpr std::int64_t kLongestGap_ns = 2'000'000'000;  // a longer pause ends a sweep

// A shorter run, or a smaller turn, is the axis settling and no sweep.
constexpr std::size_t kFewestLinesOfSweep = 10;
constexpr double kSmallestTurn_deg = 1.0;

struct TimedAngle {
  std::int64_t stamp_ns = 0;
  std::optional<double> angle_deg;
};

// Reads the whole file once: every line is checked, only its time and angle are kept.
Result<std::vector<TimedAngle>> read_angles(CsvRows& rows, std::int64_t line_duration_ns) {
  std::vector<TimedAngle> angles;
  CsvRow row;
  while (true) {
    const auto read = rows.read(row);
    if (!read) return Failure{read.reason()};
    if (!*read) break;
    if (angles.size() == kMostLinesOfARecording)
      return rows.failure("the recording is too long; cut it");
    if (!angles.empty() && row.stamp_ns <= angles.back().stamp_ns + line_duration_ns + 2 * kHair_ns)
      return rows.failure("the scan begins before the one before it has ended; stamps are wrong");
    if (!angles.empty() && row.axis_angle_deg.has_value() != angles.back().angle_deg.has_value())
      return rows.failure("the axis angle must stand in all lines or in none");
    angles.push_back({row.stamp_ns, row.axis_angle_deg});
  }
  if (angles.empty()) return rows.failure("the file has no scan line");
  return angles;
}

// From line to line in whole periods: 2 where one line is missing.
std::vector<StampedLine> number_lines(const std::vector<TimedAngle>& angles,
                                      double nominal_period_ns) {
  std::vector<StampedLine> lines(angles.size());
  for (std::size_t line = 1; line < lines.size(); ++line) {
    const auto since_ns = static_cast<double>(angles[line].stamp_ns - angles[line - 1].stamp_ns);
    const auto periods = std::max<std::int64_t>(std::llround(since_ns / nominal_period_ns), 1);
    lines[line].number = lines[line - 1].number + periods;
    lines[line].stamp_ns = static_cast<double>(angles[line].stamp_ns - angles[0].stamp_ns);
  }
  return lines;
}

// The angle at a line's end: the axis turns evenly from each stamp to the next. After the last
// stamp it is taken to go on as before.
RecordedLine::Angles angles_of(const std::vector<TimedAngle>& angles, std::size_t line,
                               std::int64_t line_duration_ns) {
  const double angle_deg = *angles[line].angle_deg;
  if (angles.size() == 1) return {angle_deg, angle_deg};
  const std::size_t from = std::min(line, angles.size() - 2);
  const double turn_deg = *angles[from + 1].angle_deg - *angles[from].angle_deg;
  const auto turn_ns = static_cast<double>(angles[from + 1].stamp_ns - angles[from].stamp_ns);
  return {angle_deg, angle_deg + turn_deg * static_cast<double>(line_duration_ns) / turn_ns};
}

void plan_lines(const std::vector<TimedAngle>& angles, const std::vector<StampedLine>& numbers,
                RecordingPlan& plan) {
  for (std::size_t line = 0; line < angles.size(); ++line) {
    RecordedLine planned;
    planned.sequence_number = static_cast<std::uint64_t>(numbers[line].number) + 1;
    planned.beam0_time_ns = angles[line].stamp_ns;
    planned.arrival_time_ns = angles[line].stamp_ns + plan.line_duration_ns();
    if (angles[line].angle_deg) planned.axis = angles_of(angles, line, plan.line_duration_ns());
    plan.lines.push_back(planned);
  }
}

// 1 while the axis turns up during the line, -1 down, 0 where it stands or nobody knows.
int direction(const std::vector<TimedAngle>& angles, std::size_t line) {
  if (line + 1 >= angles.size()) return 0;
  if (angles[line + 1].stamp_ns - angles[line].stamp_ns > kLongestGap_ns) return 0;
  const double turn_deg = *angles[line + 1].angle_deg - *angles[line].angle_deg;
  return turn_deg > 0.0 ? 1 : turn_deg < 0.0 ? -1 : 0;
}

Outcome check_size(const RecordingPlan& plan) {
  for (const RecordedSweep& sweep : plan.sweeps) {
    if (!fits_in_memory(sweep.lines_expected, plan.facts.beams))
      return Failure{"a sweep of " + std::to_string(sweep.lines_expected) +
                     " lines is too large; check the stamps, or cut the recording"};
  }
  return Done{};
}

void add_sweep(std::size_t first, std::size_t end, const std::vector<TimedAngle>& angles,
               RecordingPlan& plan) {
  const double turn_deg = *angles[end].angle_deg - *angles[first].angle_deg;
  if (end - first < kFewestLinesOfSweep || std::abs(turn_deg) < kSmallestTurn_deg) return;
  const auto turn_ns = static_cast<double>(angles[end].stamp_ns - angles[first].stamp_ns);
  RecordedSweep sweep;
  sweep.first_line = first;
  sweep.line_count = end - first;
  sweep.first_beam_time_ns = angles[first].stamp_ns;
  sweep.speed_deg_s = turn_deg / s_from_ns(turn_ns);
  sweep.lines_expected = static_cast<std::uint32_t>(plan.lines[end - 1].sequence_number -
                                                    plan.lines[first].sequence_number + 1);
  plan.sweeps.push_back(sweep);
  plan.facts.modes.push_back(0);
}

void plan_sweeps(const std::vector<TimedAngle>& angles, RecordingPlan& plan) {
  std::size_t first = 0;
  for (std::size_t line = 0; line < angles.size(); ++line) {
    const int turns = direction(angles, line);
    if (turns != direction(angles, first)) first = line;
    if (turns != 0 && turns != direction(angles, line + 1))
      add_sweep(first, line + 1, angles, plan);
  }
}

void describe(const CsvHeader& header, RecordingPlan& plan) {
  plan.facts.beams = header.beams;
  plan.line.first_beam_angle_deg(deg_from_rad(header.first_beam_angle_rad));
  plan.line.beam_step_deg(deg_from_rad(header.beam_step_rad));
  plan.line.beam_period_ns(ns_from_s(header.beam_period_s));
  plan.line.range_min_mm(static_cast<std::uint16_t>(std::lround(header.range_min_m * 1e3)));
  plan.line.range_max_mm(static_cast<std::uint16_t>(std::lround(header.range_max_m * 1e3)));
}

// The second pass, a line at a time.
Result<LineReader> line_reader(const std::string& path) {
  auto opened = CsvRows::open(path);
  if (!opened) return Failure{opened.reason()};
  const auto rows = std::make_shared<CsvRows>(std::move(*opened));
  return LineReader([rows](msg::ScanLine& line) -> Outcome {
    CsvRow row;
    const auto read = rows->read(row);
    if (!read) return Failure{read.reason()};
    if (!*read) return rows->failure("the file became shorter while it was read");
    std::replace(row.ranges_mm.begin(), row.ranges_mm.end(), std::uint16_t{0}, kNoReturn);
    line.ranges_mm(std::move(row.ranges_mm));
    line.intensities(std::move(row.intensities));
    return Done{};
  });
}

}  // namespace

Result<RecordingPlan> plan_csv_recording(const std::string& path) {
  auto rows = CsvRows::open(path);
  if (!rows) return Failure{rows.reason()};
  RecordingPlan plan;
  describe(rows->header(), plan);
  const auto angles = read_angles(*rows, plan.line_duration_ns());
  if (!angles) return Failure{angles.reason()};

  const double nominal_period_ns = ns_from_s(rows->header().nominal_scan_period_s);
  const auto numbers = number_lines(*angles, nominal_period_ns);
  plan.facts.scan_period_ns = fit_stamps({numbers}, nominal_period_ns).period_ns;
  plan.line.scan_period_ns(plan.facts.scan_period_ns);
  plan.facts.lines = angles->size();
  plan_lines(*angles, numbers, plan);
  plan.facts.axis_measured = angles->front().angle_deg.has_value();
  if (plan.facts.axis_measured) {
    plan.facts.suggested_rig = "tilting";
    plan_sweeps(*angles, plan);
    if (const Outcome checked = check_size(plan); !checked)
      return Failure{path + ": " + checked.reason()};
  } else {
    plan.facts.remark = "the recording has no axis angle: scan lines only, no sweep, no cloud";
  }
  auto reader = line_reader(path);
  if (!reader) return Failure{reader.reason()};
  plan.read_line = std::move(*reader);
  return plan;
}

}  // namespace swivel
