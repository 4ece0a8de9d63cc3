#include "components/recording/case_folder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "calibration/units.hpp"
#include "components/recording/case_lines.hpp"
#include "components/recording/case_meta.hpp"
#include "components/recording/stamp_fit.hpp"
#include "components/recording/uint16_rows.hpp"

namespace swivel {
namespace {

constexpr std::uint32_t kStampMask = (1U << 24) - 1;  // the counter wraps
constexpr double kNsPerMs = 1e6;

Result<LineReader> line_reader(const std::string& folder, std::size_t lines, std::size_t beams) {
  auto ranges = Uint16Rows::open(folder + "/ranges.u16", lines, beams);
  if (!ranges) return Failure{ranges.reason()};
  auto intensities = Uint16Rows::open(folder + "/intensity.u16", lines, beams);
  if (!intensities) return Failure{intensities.reason()};
  struct Files {
    Uint16Rows ranges, intensities;
  };
  const auto files = std::make_shared<Files>(Files{std::move(*ranges), std::move(*intensities)});
  return LineReader([files](msg::ScanLine& line) -> Outcome {
    if (Outcome read = files->ranges.read(line.ranges_mm()); !read) return read;
    std::replace(line.ranges_mm().begin(), line.ranges_mm().end(), std::uint16_t{0}, kNoReturn);
    return files->intensities.read(line.intensities());
  });
}

std::vector<std::vector<StampedLine>> stamped(const std::vector<CaseLine>& lines,
                                              std::size_t sweeps) {
  std::vector<std::vector<StampedLine>> stamped(sweeps);
  std::vector<std::uint32_t> first_stamp_ms(sweeps);
  for (const CaseLine& line : lines) {
    if (stamped[line.sweep].empty()) first_stamp_ms[line.sweep] = line.device_stamp_ms;
    const std::uint32_t since_ms = (line.device_stamp_ms - first_stamp_ms[line.sweep]) & kStampMask;
    stamped[line.sweep].push_back({line.line, since_ms * kNsPerMs});
  }
  return stamped;
}

// A stamp half a turn off has a wrong line number, or is wrong itself.
Outcome check_stamps(const std::vector<std::vector<StampedLine>>& sweeps, const StampFit& fit,
                     double nominal_period_ns) {
  if (std::abs(fit.period_ns / nominal_period_ns - 1.0) > 0.1)
    return Failure{"the lidar's stamps are " + std::to_string(fit.period_ns / kNsPerMs) +
                   " ms apart, far from the period in meta.csv; stamps or line numbers are wrong"};
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    for (const StampedLine& line : sweeps[sweep]) {
      const double off_ns = residual_ns(fit, sweep, line);
      if (std::abs(off_ns) > 0.5 * nominal_period_ns)
        return Failure{"sweep " + std::to_string(sweep) + ", line " + std::to_string(line.number) +
                       ": its stamp is " + std::to_string(std::lround(off_ns / kNsPerMs)) +
                       " ms from where the other lines put it; stamp or line number is wrong"};
    }
  }
  return Done{};
}

// The host's time of line number 0 of each sweep: the line that came quickest left the lidar
// when its last beam was in.
std::vector<double> first_beam_times_ns(const std::vector<CaseLine>& lines, const StampFit& fit,
                                        double line_duration_ns) {
  std::vector<double> times_ns(fit.first_ns.size(), std::numeric_limits<double>::infinity());
  for (const CaseLine& line : lines) {
    const double time_ns = ns_from_s(line.arrival_s) - line.line * fit.period_ns - line_duration_ns;
    times_ns[line.sweep] = std::min(times_ns[line.sweep], time_ns);
  }
  return times_ns;
}

// Sweeps follow one another in the host's time.
Outcome check_order(const CaseMeta& meta, const std::vector<double>& first_beam_ns,
                    double period_ns) {
  for (std::size_t sweep = 1; sweep < first_beam_ns.size(); ++sweep) {
    const double end_ns = first_beam_ns[sweep - 1] + meta.sweeps[sweep - 1].lines * period_ns;
    if (first_beam_ns[sweep] < end_ns)
      return Failure{"sweep " + std::to_string(sweep) +
                     " begins before the one before it has ended; host_s is wrong"};
  }
  return Done{};
}

void plan_sweeps(const CaseMeta& meta, const std::vector<double>& first_beam_ns,
                 RecordingPlan& plan) {
  for (std::size_t sweep = 0; sweep < meta.sweeps.size(); ++sweep) {
    RecordedSweep planned;
    planned.first_beam_time_ns = std::llround(first_beam_ns[sweep]);
    planned.mode = meta.sweeps[sweep].mode;
    planned.action_sequence = meta.naive ? msg::SEQUENCE_NAIVE : msg::SEQUENCE_IMPROVED;
    planned.speed_deg_s = meta.sweeps[sweep].speed_deg_s;
    planned.lines_expected = meta.sweeps[sweep].lines;
    plan.sweeps.push_back(planned);
    plan.facts.modes.push_back(planned.mode);
  }
}

void plan_lines(const CaseMeta& meta, const std::vector<CaseLine>& lines, RecordingPlan& plan) {
  std::uint64_t lines_of_sweeps_before = 0;
  for (std::size_t index = 0; index < lines.size(); ++index) {
    const CaseLine& line = lines[index];
    if (index > 0 && line.sweep != lines[index - 1].sweep)
      lines_of_sweeps_before += meta.sweeps[line.sweep - 1].lines;
    RecordedSweep& sweep = plan.sweeps[line.sweep];
    if (sweep.line_count++ == 0) sweep.first_line = index;

    RecordedLine planned;
    planned.sequence_number = lines_of_sweeps_before + line.line + 1;
    planned.beam0_time_ns =
        sweep.first_beam_time_ns + std::llround(line.line * plan.line.scan_period_ns());
    planned.arrival_time_ns = std::llround(ns_from_s(line.arrival_s));
    planned.device_stamp_ms = line.device_stamp_ms;
    if (line.axis_angle_deg)  // the pan unit stands still while a line is taken
      planned.axis = {*line.axis_angle_deg, *line.axis_angle_deg};
    plan.lines.push_back(planned);
  }
}

void describe(const CaseMeta& meta, std::size_t lines, double period_ns, RecordingPlan& plan) {
  plan.line.first_beam_angle_deg(meta.first_beam_angle_deg);
  plan.line.beam_step_deg(meta.beam_step_deg);
  plan.line.beam_period_ns(period_ns / meta.steps_per_turn);
  plan.line.scan_period_ns(period_ns);
  plan.line.range_min_mm(static_cast<std::uint16_t>(std::lround(meta.range_min_m * 1e3)));
  plan.line.range_max_mm(static_cast<std::uint16_t>(std::lround(meta.range_max_m * 1e3)));
  plan.facts.suggested_rig = meta.plate ? "yuan" : "zeng";
  plan.facts.axis_measured = !meta.plate;
  plan.facts.lines = lines;
  plan.facts.beams = meta.beams;
  plan.facts.scan_period_ns = period_ns;
  plan.facts.plate = meta.plate;
}

}  // namespace

Result<RecordingPlan> plan_case_folder(const std::string& folder) {
  const auto meta = read_case_meta(folder + "/meta.csv");
  if (!meta) return Failure{meta.reason()};
  const auto lines = read_case_lines(folder + "/lines.csv", *meta);
  if (!lines) return Failure{lines.reason()};

  const double nominal_period_ns = ns_from_s(meta->nominal_period_s);
  const auto stamps = stamped(*lines, meta->sweeps.size());
  const StampFit fit = fit_stamps(stamps, nominal_period_ns);
  if (const Outcome checked = check_stamps(stamps, fit, nominal_period_ns); !checked)
    return Failure{folder + "/lines.csv: " + checked.reason()};

  RecordingPlan plan;
  describe(*meta, lines->size(), fit.period_ns, plan);
  const auto line_duration_ns = static_cast<double>(plan.line_duration_ns());
  const auto first_beam_ns = first_beam_times_ns(*lines, fit, line_duration_ns);
  if (const Outcome checked = check_order(*meta, first_beam_ns, fit.period_ns); !checked)
    return Failure{folder + "/lines.csv: " + checked.reason()};
  plan_sweeps(*meta, first_beam_ns, plan);
  plan_lines(*meta, *lines, plan);
  auto reader = line_reader(folder, lines->size(), meta->beams);
  if (!reader) return Failure{reader.reason()};
  plan.read_line = std::move(*reader);
  return plan;
}

}  // namespace swivel
