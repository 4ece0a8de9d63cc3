// What of a Calibration a rig may use, and whether it is that rig's and its lidar's at all.
#pragma once

#include <optional>
#include <string>

#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

// What was estimated has a variance. A calibration without any is of alpha, as its files were
// before there were variances.
bool tells_alpha(const msg::Calibration& calibration);
bool tells_mounting(const msg::Calibration& calibration);

// The drawn geometry, with the bias, the mounting and the hysteresis that the calibration tells.
RigGeometry calibrated_geometry(const RigGeometry& drawn, const msg::Calibration& calibration);

// The geometry's bias, mounting and hysteresis, into the calibration.
void set_mounting(const RigGeometry& geometry, msg::Calibration& calibration);

// What the calibration found, with what the one before it knew and it did not look for. A mounting
// moves the clouds that alpha was found in, so that no alpha outlives it.
msg::Calibration completed(const msg::Calibration& found,
                           const std::optional<msg::Calibration>& before);

// The calibration that a participant uses: the last one told, unless it is of another rig or of
// another lidar than the one that scans. What is not known, as a recording's lidar, is not another.
class CalibrationInUse {
 public:
  explicit CalibrationInUse(std::string rig) : rig_(std::move(rig)) {}

  // Each says why the calibration is refused, or nothing.
  std::string take(const msg::Calibration& calibration);
  std::string name_lidar(const std::string& serial_number);

  // None: the rig is as drawn.
  const std::optional<msg::Calibration>& now() const { return now_; }

 private:
  std::string why_not(const msg::Calibration& calibration) const;

  std::string rig_;
  std::string serial_number_;             // of the lidar that scans
  std::optional<msg::Calibration> last_;  // told, and of this rig
  std::optional<msg::Calibration> now_;
};

// The serial number of the lidar, from the health of its reader; none from another's.
std::optional<std::string> lidar_serial_number(const msg::Health& health);

}  // namespace swivel
