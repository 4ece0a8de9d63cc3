#include "components/recording/csv_header.hpp"

#include "components/recording/text.hpp"

namespace swivel {
namespace {

class HeaderReader {
 public:
  explicit HeaderReader(const CsvMetadata& metadata) : metadata_(metadata) {}

  double number(const std::string& name, double least, double most) {
    const auto found = metadata_.find(name);
    if (found == metadata_.end()) return refuse(name + ": is missing in the lines with #", least);
    const auto number = parse_number<double>(found->second, least, most);
    if (number) return *number;
    return refuse(
        name + ": must be a number from " + std::to_string(least) + " to " + std::to_string(most),
        least);
  }

  double refuse(const std::string& reason, double stand_in) {
    if (reason_.empty()) reason_ = reason;
    return stand_in;
  }
  const std::string& reason() const { return reason_; }

 private:
  const CsvMetadata& metadata_;
  std::string reason_;
};

}  // namespace

void collect_metadata(std::string_view comment, CsvMetadata& metadata) {
  const auto words = split(comment, ' ');
  for (std::size_t word = 0; word + 1 < words.size(); ++word) {
    const std::string_view name = words[word];
    if (name.size() < 2 || name.back() != ':') continue;
    metadata.emplace(name.substr(0, name.size() - 1), words[word + 1]);
  }
}

Result<CsvHeader> header_from(const CsvMetadata& metadata) {
  HeaderReader reader(metadata);
  CsvHeader header;
  header.beams = static_cast<std::size_t>(reader.number("beams", 2, 20000));
  header.first_beam_angle_rad = reader.number("first_beam_angle_rad", -6.3, 6.3);
  header.beam_step_rad = reader.number("beam_step_rad", -0.2, 0.2);
  header.beam_period_s = reader.number("time_increment_s", 0.0, 0.1);
  header.nominal_scan_period_s = reader.number("scan_time_s", 1e-3, 10.0);
  header.range_min_m = reader.number("range_min_m", 0.0, 65.0);
  header.range_max_m = reader.number("range_max_m", header.range_min_m, 65.0);
  const double beams_last_s = static_cast<double>(header.beams) * header.beam_period_s;
  if (beams_last_s > 1.01 * header.nominal_scan_period_s)
    reader.refuse("time_increment_s: the beams of a scan take longer than scan_time_s", 0.0);
  if (!reader.reason().empty()) return Failure{reader.reason()};
  return header;
}

}  // namespace swivel
