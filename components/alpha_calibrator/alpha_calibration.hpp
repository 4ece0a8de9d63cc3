// From the attitudes and raw clouds of some sweeps to a Calibration of alpha.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/alpha.hpp"
#include "calibration/attitude.hpp"
#include "calibration/plate_learning.hpp"
#include "components/alpha_calibrator/calibration_outcome.hpp"
#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct AlphaWishes {
  double room_yaw_deg = 0.0;
  std::size_t least_sweeps = AlphaOptions().least_sweeps;
  std::optional<double> sigma_deg = std::nullopt;  // then the outcome says how many sweeps it takes
};

// How many more sweeps such a sigma takes, or that none will do.
std::string more_sweeps_in_words(const AlphaFit& fit, double sigma_deg);

class AlphaCalibration {
 public:
  // Throws ConfigurationError where the rig has no plate.
  AlphaCalibration(const RigFile& rig, const AlphaWishes& wishes);

  // cloud: the sweep's raw cloud, in frame O'. name: as the user knows the sweep, or empty for its
  // id.
  using Added = CalibrationAdded;
  Added add(const msg::Attitude& attitude, const OrganisedCloud& cloud,
            const std::string& name = "");

  std::size_t sweeps_used() const { return sweeps_.size(); }

  using Outcome = CalibrationOutcome;
  Outcome fit(const LidarName& lidar, std::int64_t time_ns) const;

 private:
  std::string origin_in_words(const AlphaFit& fit) const;
  msg::Calibration to_message(const AlphaFit& fit, const LidarName& lidar,
                              std::int64_t time_ns) const;

  std::vector<AlphaSweep> with_learned_betas(const LearnedPlate& plate) const;

  std::string rig_;
  PlateGeometry drawn_;
  std::optional<AttitudeEstimator> estimate_;
  AlphaOptions options_;
  std::vector<AlphaSweep> sweeps_;
  std::vector<PlateFit> fits_;  // of each sweep, where the estimator makes them
  std::optional<double> wanted_sigma_deg_;
  std::string estimator_;
  std::set<int> modes_;
};

}  // namespace swivel
