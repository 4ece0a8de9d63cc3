// Files that a user writes, and the one that the calibrator keeps.
#include <cmath>

#include "components/common/calibration_file.hpp"
#include "components/common/calibration_use.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/strict_yaml.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace swivel::fuzz {

void rig_file(std::string_view bytes) {
  static const MemoryFile file;
  file.hold(bytes);
  try {
    const RigFile rig = load_rig_file(file.path());
    must(rig.geometry.T_axis_lidar.matrix().allFinite());
    must(rig.geometry.T_base_axis.matrix().allFinite());
    must(!rig.rig.empty() && rig.rig.size() <= 32 && !rig.modes.lines.empty());
  } catch (const ConfigurationError&) {
    // Refused, in words.
  }
}

void calibration(std::string_view bytes) {
  static const MemoryFile file;
  file.hold(bytes);
  try {
    const msg::Calibration read = load_calibration(file.path());
    must(std::isfinite(alpha_sigma_deg(read)));
    must(calibrated_geometry(RigGeometry{}, read).T_axis_lidar.matrix().allFinite());
    CalibrationInUse in_use(read.rig().to_string());
    in_use.take(read);
  } catch (const ConfigurationError&) {
    // Refused, in words.
  }
}

}  // namespace swivel::fuzz
