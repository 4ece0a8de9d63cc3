#include "components/swivel/live/truth_file.hpp"

#include <fstream>
#include <sstream>

#include "components/common/program.hpp"

namespace swivel {

TruthFile::TruthFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw ExitError(kExitNoInput, path + ": the bench's truth cannot be read");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    char comma = 0;
    if (line.rfind("# ", 0) == 0) {
      std::string key;
      double value = 0.0;
      words.ignore(2);
      if (words >> key >> value) numbers_[key] = value;
      continue;
    }
    std::uint32_t stamp_ms = 0;
    std::int64_t time_ns = 0;
    double phi_deg = 0.0;
    if (words >> stamp_ms >> comma >> time_ns >> comma >> phi_deg) {
      phi_deg_[stamp_ms] = phi_deg;
      lines_.push_back({time_ns, phi_deg});
    }
  }
}

std::optional<double> TruthFile::phi_deg(std::uint32_t device_stamp_ms) const {
  const auto found = phi_deg_.find(device_stamp_ms);
  return found == phi_deg_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> TruthFile::number(const std::string& key) const {
  const auto found = numbers_.find(key);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace swivel
