// One sweep after all stages, live or from a recording.
#pragma once

#include <cstddef>

#include "calibration/organised_cloud.hpp"
#include "calibration/sweep_readings.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct ProcessedSweep {
  std::size_t index = 0;  // counted from 0
  msg::Sweep sweep;       // as assembled
  msg::Attitude attitude;
  OrganisedCloud raw;      // in frame O'; of a rig that measures its axis in the base
  OrganisedCloud cloud;    // in the base if the attitude's verdict says so, else as raw
  SweepReadings readings;  // what the cloud was made of, where that is kept
};

}  // namespace swivel
