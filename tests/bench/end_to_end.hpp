// From the last line published to the corrected cloud taken, with assembler and corrector as
// processes of their own.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace swivel {

struct EndToEnd {
  std::vector<double> times_ms;
  double median_ms = 0.0;
  std::map<std::string, double> peak_memory_mb;  // by process
};

// With keys, encrypted; the participant that publishes is "benchmark".
EndToEnd measure_end_to_end(int sweeps, const std::string& security_folder = {});

}  // namespace swivel
