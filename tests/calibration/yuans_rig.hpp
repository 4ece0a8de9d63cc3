// The rig of Yuan 2021: the lidar's centre stands 13.9 mm off the shaft (table 2).
#pragma once

#include "calibration/rig.hpp"

namespace swivel {

inline RigGeometry yuans_rig() {
  RigGeometry rig;
  rig.T_axis_lidar.translation() << 0.0139, 0.0, 0.0;
  return rig;
}

}  // namespace swivel
