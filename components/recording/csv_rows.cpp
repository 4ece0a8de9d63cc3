#include "components/recording/csv_rows.hpp"

#include <limits>
#include <utility>

#include "components/recording/text.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kLatestStamp_ns = std::numeric_limits<std::int64_t>::max() / 2;

// Numbers separated by spaces. False when one is none.
bool parse_numbers(std::string_view text, std::vector<std::uint16_t>& numbers) {
  numbers.clear();
  while (!text.empty()) {
    const auto space = text.find(' ');
    const auto number = parse_number<std::uint16_t>(text.substr(0, space));
    if (!number) return false;
    numbers.push_back(*number);
    if (space == std::string_view::npos) break;
    text.remove_prefix(space + 1);
  }
  return true;
}

}  // namespace

Result<CsvRows> CsvRows::open(const std::string& path) {
  auto lines = GzipLines::open(path);
  if (!lines) return Failure{lines.reason()};
  CsvRows rows(std::move(*lines));
  if (const Outcome read = rows.read_header(); !read) return Failure{read.reason()};
  return rows;
}

Outcome CsvRows::read_header() {
  CsvMetadata metadata;
  while (true) {
    const auto line = lines_.next();
    if (!line) return Failure{line.reason()};
    if (!line->has_value()) return lines_.failure("the file ends before its first scan line");
    if ((*line)->empty() || (*line)->front() != '#') {
      first_row_ = **line;
      break;
    }
    collect_metadata(**line, metadata);
  }
  if (metadata.empty())
    return lines_.failure("this is no recording: it does not begin with lines of `# name: value`");
  const auto header = header_from(metadata);
  if (!header) return lines_.failure(header.reason());
  header_ = *header;
  return Done{};
}

Result<bool> CsvRows::read(CsvRow& row) {
  Outcome parsed = Done{};
  if (!first_row_.empty()) {
    parsed = parse(std::exchange(first_row_, {}), row);
  } else {
    const auto line = lines_.next();
    if (!line) return Failure{line.reason()};
    if (!line->has_value()) return false;
    parsed = parse(**line, row);
  }
  if (!parsed) return Failure{parsed.reason()};
  return true;
}

Outcome CsvRows::parse(std::string_view text, CsvRow& row) const {
  const auto fields = split(text, ';');
  if (fields.size() != 4)
    return failure("expected `stamp_ns;axis_angle_deg;ranges_mm;intensities`");
  const auto stamp_ns = parse_number<std::int64_t>(fields[0], 0, kLatestStamp_ns);
  if (!stamp_ns) return failure("the stamp is no number of nanoseconds");
  row.stamp_ns = *stamp_ns;
  row.axis_angle_deg = parse_number<double>(fields[1], -36000.0, 36000.0);
  if (!row.axis_angle_deg && !fields[1].empty()) return failure("the axis angle is no angle");
  if (!parse_numbers(fields[2], row.ranges_mm) || row.ranges_mm.size() != header_.beams)
    return failure("expected " + std::to_string(header_.beams) + " ranges from 0 to 65535");
  if (!parse_numbers(fields[3], row.intensities) ||
      (!row.intensities.empty() && row.intensities.size() != header_.beams))
    return failure("expected no intensities, or " + std::to_string(header_.beams) +
                   " from 0 to 65535");
  return Done{};
}

}  // namespace swivel
