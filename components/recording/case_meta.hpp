// meta.csv of a case folder: what a user of the rig knows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/recording/recording.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct CaseMeta {
  std::size_t beams = 0;
  double first_beam_angle_deg = 0.0;
  double beam_step_deg = 0.0;
  double nominal_period_s = 0.0;
  double steps_per_turn = 0.0;
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  bool naive = false;

  struct Sweep {
    std::uint8_t mode = 0;
    std::uint32_t lines = 0;
    double speed_deg_s = 0.0;
  };
  std::vector<Sweep> sweeps;
  std::optional<RecordingFacts::Plate> plate;  // the plate rig; otherwise the pan rig
};

Result<CaseMeta> read_case_meta(const std::string& path);

}  // namespace swivel
