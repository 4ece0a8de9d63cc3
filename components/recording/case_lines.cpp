#include "components/recording/case_lines.hpp"

#include "components/recording/gzip_lines.hpp"
#include "components/recording/text.hpp"

namespace swivel {
namespace {

constexpr std::string_view kHeading = "sweep,line,lidar_ms,host_s,pan_deg";
constexpr std::uint32_t kLastStamp_ms = (1U << 24) - 1;
constexpr double kLatestArrival_s = 8e9;  // as nanoseconds it still fits int64

std::optional<CaseLine> parse_line(std::string_view text, const CaseMeta& meta) {
  const auto fields = split(text, ',');
  if (fields.size() != 5) return std::nullopt;
  const auto sweep = parse_number<std::size_t>(fields[0], 0, meta.sweeps.size() - 1);
  if (!sweep) return std::nullopt;
  const auto line = parse_number<std::uint32_t>(fields[1], 0, meta.sweeps[*sweep].lines - 1);
  const auto stamp_ms = parse_number<std::uint32_t>(fields[2], 0, kLastStamp_ms);
  const auto arrival_s = parse_number<double>(fields[3], 0.0, kLatestArrival_s);
  if (!line || !stamp_ms || !arrival_s) return std::nullopt;

  CaseLine parsed{*sweep, *line, *stamp_ms, *arrival_s, std::nullopt};
  if (fields[4].empty()) return meta.plate ? std::optional(parsed) : std::nullopt;
  parsed.axis_angle_deg = parse_number<double>(fields[4], -36000.0, 36000.0);
  return parsed.axis_angle_deg && !meta.plate ? std::optional(parsed) : std::nullopt;
}

// Nothing when the line may follow the one before it.
std::string out_of_order(const std::vector<CaseLine>& lines, const CaseLine& next) {
  const std::size_t sweep_before = lines.empty() ? 0 : lines.back().sweep;
  if (lines.empty() ? next.sweep != 0 : next.sweep > sweep_before + 1)
    return "a whole sweep is missing before this line";
  if (lines.empty() || next.sweep == sweep_before + 1) return {};
  if (next.sweep < sweep_before || next.line <= lines.back().line)
    return "sweeps and lines must be in order";
  return {};
}

}  // namespace

Result<std::vector<CaseLine>> read_case_lines(const std::string& path, const CaseMeta& meta) {
  auto file = GzipLines::open(path);
  if (!file) return Failure{file.reason()};
  const auto heading = file->next();
  if (!heading) return Failure{heading.reason()};
  if (*heading != kHeading)
    return file->failure("the heading must be `" + std::string(kHeading) + "`");

  std::vector<CaseLine> lines;
  while (true) {
    const auto text = file->next();
    if (!text) return Failure{text.reason()};
    if (!text->has_value()) break;
    const auto line = parse_line(**text, meta);
    if (!line)
      return file->failure("expected numbers as meta.csv allows them under `" +
                           std::string(kHeading) + "`");
    if (const std::string reason = out_of_order(lines, *line); !reason.empty())
      return file->failure(reason);
    lines.push_back(*line);
  }
  if (lines.empty() || lines.back().sweep + 1 != meta.sweeps.size())
    return file->failure("the file ends before the last sweep that meta.csv announces");
  return lines;
}

}  // namespace swivel
