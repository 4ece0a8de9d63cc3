#include "hardware/sim/truth_file.hpp"

#include <cstdio>
#include <stdexcept>

namespace swivel::sim {

TruthFile::TruthFile(const std::string& path) : path_(path) {
  if (path_.empty()) return;
  file_.open(path_, std::ios::trunc);
  check();
}

void TruthFile::check() {
  if (path_.empty() || file_) return;
  throw std::runtime_error("cannot write the truth to " + path_ +
                           ": is the folder there, and is there room on the disk?");
}

void TruthFile::note(const std::string& key, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.9g", value);
  if (!path_.empty()) file_ << "# " << key << ' ' << text << std::endl;
}

void TruthFile::note(const std::string& key, std::uint64_t value) {
  if (!path_.empty()) file_ << "# " << key << ' ' << value << std::endl;
}

void TruthFile::begin_rows() {
  if (!path_.empty()) file_ << "device_stamp_ms,beam0_time_ns,phi_deg" << std::endl;
  check();
}

void TruthFile::row(std::uint32_t device_stamp_ms, std::int64_t beam0_time_ns, double phi_deg) {
  if (path_.empty()) return;
  char text[96];
  std::snprintf(text, sizeof text, "%u,%lld,%.6f", device_stamp_ms,
                static_cast<long long>(beam0_time_ns), phi_deg);
  file_ << text << std::endl;
  check();
}

}  // namespace swivel::sim
