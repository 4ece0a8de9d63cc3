// The metadata of a .csv.gz recording: lines beginning with #, with `name: value` in them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "hardware/result.hpp"

namespace swivel {

struct CsvHeader {
  std::size_t beams = 0;
  double first_beam_angle_rad = 0.0;
  double beam_step_rad = 0.0;
  double beam_period_s = 0.0;
  double nominal_scan_period_s = 0.0;
  double range_min_m = 0.0;
  double range_max_m = 0.0;
};

// `name: value` pairs found so far; a name keeps its first value.
using CsvMetadata = std::map<std::string, std::string, std::less<>>;

void collect_metadata(std::string_view comment, CsvMetadata& metadata);
Result<CsvHeader> header_from(const CsvMetadata& metadata);

}  // namespace swivel
