// From a raw cloud in frame O' to the cloud in the rig's base, and what the plate told of it.
#pragma once

#include <optional>
#include <string>

#include "calibration/attitude.hpp"
#include "components/attitude_corrector/calibration_watch.hpp"
#include "components/common/calibration_use.hpp"
#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

class Corrector {
 public:
  // Throws ConfigurationError if the rig asks for an estimator that does not exist, or has a
  // commanded axis and no plate.
  explicit Corrector(const RigFile& rig);

  // From the next sweep on. Both say why the calibration is refused, or nothing; without one alpha
  // and mounting are as drawn.
  std::string set_calibration(const msg::Calibration& calibration);
  std::string name_lidar(const std::string& serial_number);

  // Estimates the attitude and, if it is good, turns the cloud into the base. A cloud whose
  // attitude is not good is left as it came.
  msg::Attitude correct(const msg::Sweep& sweep, OrganisedCloud& cloud);

  // Whether a cloud of that verdict stands in the rig's base.
  static bool in_base(msg::Verdict verdict) {
    return verdict == msg::VERDICT_GOOD || verdict == msg::VERDICT_MEASURED;
  }

 private:
  void use_calibration();
  void judge_turn(const msg::Sweep& sweep, const SeamEstimate& seam, msg::Attitude& attitude) const;
  void fill(const AttitudeEstimate& estimate, msg::Attitude& attitude) const;

  RigFile drawn_;
  RigFile rig_;  // as calibrated
  CalibrationInUse calibration_;
  std::optional<AttitudeEstimator> estimator_;  // none where the axis is measured
  double alpha_sigma_deg_ = 0.0;
  bool calibrated_ = false;
  CalibrationWatch watch_;
};

// As in files and on the command line: "good", "no_plate".
const char* verdict_word(msg::Verdict verdict);

}  // namespace swivel
