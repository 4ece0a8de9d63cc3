// A Calibration as a YAML file: what a calibrator found, with its covariance and where it comes
// from.
#pragma once

#include <cstddef>
#include <string>

#include "swivel/idl/swivel.h"

namespace swivel {

// Row and column of each quantity in Calibration::covariance.
enum CalibrationIndex { kAlpha, kBias, kMountingX, kMountingY, kMountingZ, kRoll, kPitch, kYaw };
inline constexpr std::size_t kCalibrationSize = 8;

double alpha_sigma_deg(const msg::Calibration& calibration);

// Throws ConfigurationError, with file and line.
msg::Calibration load_calibration(const std::string& path);

// Written beside and renamed, so that a reader never sees half of it. Makes the directory.
// Says what went wrong, or nothing.
[[nodiscard]] std::string save_calibration(const msg::Calibration& calibration,
                                           const std::string& path);

// Where calibrations of a rig are kept: $STATE_DIRECTORY (systemd), $XDG_STATE_HOME or
// ~/.local/state, never beside the shipped configuration.
std::string default_calibration_path(const std::string& rig);

}  // namespace swivel
