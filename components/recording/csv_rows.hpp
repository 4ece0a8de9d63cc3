// The scan lines of a .csv.gz recording, one by one: `stamp_ns;axis_angle_deg;ranges;intensities`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/recording/csv_header.hpp"
#include "components/recording/gzip_lines.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct CsvRow {
  std::int64_t stamp_ns = 0;
  std::optional<double> axis_angle_deg;
  std::vector<std::uint16_t> ranges_mm;    // 0 where the file says 0: not finite
  std::vector<std::uint16_t> intensities;  // empty, or one a beam
};

class CsvRows {
 public:
  // Reads as far as the first scan line.
  static Result<CsvRows> open(const std::string& path);

  const CsvHeader& header() const { return header_; }

  // False at the end. Fails with file and line on anything that is not a whole scan line.
  Result<bool> read(CsvRow& row);

  // A failure at the line read last.
  Failure failure(const std::string& reason) const { return lines_.failure(reason); }

 private:
  explicit CsvRows(GzipLines lines) : lines_(std::move(lines)) {}
  Outcome read_header();
  Outcome parse(std::string_view text, CsvRow& row) const;

  GzipLines lines_;
  CsvHeader header_;
  std::string first_row_;  // came to light while the header was read
};

}  // namespace swivel
