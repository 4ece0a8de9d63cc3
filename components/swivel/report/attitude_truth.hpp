// What a simulator wrote beside its recording: where each sweep really began.
//   a case's truth.csv     key,value: alpha_deg, sweep0_phi_start_deg, sweep1_...; of a pan rig
//                          sweep0_obs_rx_deg, the roll that a bias is one with
//   swivel-bench --truth   as TruthFile reads it
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "components/swivel/live/truth_file.hpp"

namespace swivel {

class AttitudeTruth {
 public:
  // Throws ExitError if it cannot be read.
  explicit AttitudeTruth(const std::string& path);

  // Azimuth in O at which the sweep began: what phi_offset should say. sweep: counted from 0.
  std::optional<double> phi_start_deg(std::size_t sweep, std::uint32_t device_stamp_ms) const;
  std::optional<double> alpha_deg() const;
  // Of the centreline, the mounting's roll in it.
  std::optional<double> bias_deg(std::size_t sweep) const;

 private:
  std::map<std::string, double> case_;
  TruthFile bench_;
};

}  // namespace swivel
