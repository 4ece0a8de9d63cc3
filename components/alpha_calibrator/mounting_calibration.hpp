// From the mountings that single sweeps show to a Calibration of bias and mounting.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "calibration/mounting.hpp"
#include "components/alpha_calibrator/calibration_outcome.hpp"
#include "components/common/rig_file.hpp"

namespace swivel {

// "bias 3.7474 +- 0.0005 deg, ry ..."
std::string mounting_in_words(const MountingFit& fit);

class MountingCalibration {
 public:
  explicit MountingCalibration(const RigFile& rig) : rig_(rig) {}

  // result: of fit_mounting on the sweep's readings and the drawn geometry.
  CalibrationAdded add(int mode, const MountingResult& result);

  std::size_t sweeps_used() const { return fits_.size(); }

  CalibrationOutcome fit(const LidarName& lidar, std::int64_t time_ns) const;

 private:
  msg::Calibration to_message(const JointMounting& joint, const LidarName& lidar,
                              std::int64_t time_ns) const;

  RigFile rig_;
  std::vector<MountingFit> fits_;
  std::set<int> modes_;
};

}  // namespace swivel
