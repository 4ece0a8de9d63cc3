// swivel calibrate mounting RECORDING: the mounting from a recording's sweeps, into files.
#pragma once

#include <string>

namespace swivel {

struct RecordedMountingOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;    // empty: that which suits the recording
  bool per_sweep = false;  // each alone, instead of all together
};

// Writes mounting.json, and calibration.yaml where the sweeps have one mounting; of each sweep its
// own calibration_NN.yaml with per_sweep. Throws ExitError, as where they have not.
void calibrate_recorded_mounting(const RecordedMountingOptions& options);

}  // namespace swivel
