// What really happened: comment lines `# key value`, a header, and a row for each scan line
// sent. Written line by line, so that a reader sees all of it at any time.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace swivel::sim {

class TruthFile {
 public:
  // An empty path: nothing is written. Throws std::runtime_error.
  explicit TruthFile(const std::string& path);

  void note(const std::string& key, double value);
  void note(const std::string& key, std::uint64_t value);
  void begin_rows();
  // `phi_deg`: azimuth of the scan plane's normal in frame O at the line's first beam.
  void row(std::uint32_t device_stamp_ms, std::int64_t beam0_time_ns, double phi_deg);

 private:
  void check();

  std::string path_;
  std::ofstream file_;
};

}  // namespace swivel::sim
