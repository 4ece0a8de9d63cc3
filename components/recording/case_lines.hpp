// lines.csv of a case folder: when each line was stamped and arrived, and the measured angle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/recording/case_meta.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct CaseLine {
  std::size_t sweep = 0;
  std::uint32_t line = 0;  // in its sweep; a hole is a line that is missing
  std::uint32_t device_stamp_ms = 0;
  double arrival_s = 0.0;
  std::optional<double> axis_angle_deg;
};

// In order of sweep and line; every sweep has one line at least. Fails with file and line.
Result<std::vector<CaseLine>> read_case_lines(const std::string& path, const CaseMeta& meta);

}  // namespace swivel
