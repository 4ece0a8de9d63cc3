#include "components/swivel/report/attitude_truth.hpp"

#include <fstream>

#include "components/recording/text.hpp"

namespace swivel {

AttitudeTruth::AttitudeTruth(const std::string& path) : bench_(path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto fields = split(line, ',');
    if (fields.size() != 2) continue;
    if (const auto value = parse_number<double>(fields[1])) case_[std::string(fields[0])] = *value;
  }
}

std::optional<double> AttitudeTruth::phi_start_deg(std::size_t sweep,
                                                   std::uint32_t device_stamp_ms) const {
  const auto found = case_.find("sweep" + std::to_string(sweep) + "_phi_start_deg");
  return found == case_.end() ? bench_.phi_deg(device_stamp_ms) : std::optional(found->second);
}

std::optional<double> AttitudeTruth::alpha_deg() const {
  const auto found = case_.find("alpha_deg");
  return found == case_.end() ? bench_.number("alpha_deg") : std::optional(found->second);
}

std::optional<double> AttitudeTruth::bias_deg(std::size_t sweep) const {
  const auto found = case_.find("sweep" + std::to_string(sweep) + "_obs_rx_deg");
  return found == case_.end() ? bench_.number("bias_deg") : std::optional(-found->second);
}

}  // namespace swivel
