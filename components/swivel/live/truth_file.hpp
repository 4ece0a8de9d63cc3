// What swivel-bench writes of what really happened: for each line its stamp and the shaft's true
// azimuth at its first beam.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace swivel {

class TruthFile {
 public:
  // Throws ExitError if it cannot be read.
  explicit TruthFile(const std::string& path);

  // Of the last line with that stamp.
  std::optional<double> phi_deg(std::uint32_t device_stamp_ms) const;
  std::optional<double> number(const std::string& key) const;

  // Of every line, in order.
  struct Line {
    std::int64_t beam0_time_ns;
    double phi_deg;
  };
  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
  std::map<std::uint32_t, double> phi_deg_;
  std::map<std::string, double> numbers_;
};

}  // namespace swivel
