// From the attitudes and raw clouds of some sweeps to a Calibration of alpha.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/alpha.hpp"
#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct LidarName {
  std::string serial_number;
  std::string firmware;
};

class AlphaCalibration {
 public:
  // Throws ConfigurationError where the rig has no plate.
  AlphaCalibration(const RigFile& rig, double room_yaw_deg);

  // cloud: the sweep's raw cloud, in frame O'. Says in words why the sweep is left out, or what
  // it brought.
  struct Added {
    bool used;
    std::string words;
  };
  Added add(const msg::Attitude& attitude, const OrganisedCloud& cloud);

  std::size_t sweeps_used() const { return sweeps_.size(); }

  struct Outcome {
    std::optional<msg::Calibration> calibration;
    std::string words;  // of the result, or why it was refused
  };
  Outcome fit(const LidarName& lidar, std::int64_t time_ns) const;

 private:
  msg::Calibration to_message(const AlphaFit& fit, const LidarName& lidar,
                              std::int64_t time_ns) const;

  std::string rig_;
  AlphaOptions options_;
  std::vector<AlphaSweep> sweeps_;
  std::string estimator_;
  int mode_ = 0;
};

}  // namespace swivel
