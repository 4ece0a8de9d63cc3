// How flat the roof comes out, or the floor, before a calibration, by each step of Zeng 2018 alone,
// and by both: what a bias bends most. His figures 10 and 11.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibration/mounting.hpp"

namespace swivel {

inline constexpr std::size_t kRoofSteps = 4;
inline constexpr std::array<const char*, kRoofSteps> kRoofStepNames = {
    "as the rig file has it", "mounting without the bias", "bias alone", "both"};

// The rays within 45 deg of the axis that meet the roof, or the floor where more of them do that,
// as the fit has roof and mounting; those of the sweep's first half come first.
struct RoofLook {
  std::vector<RayPlace> rays;
  std::size_t front = 0;  // so many are of the first half, the others of the half that follows
  std::vector<double> along_m;  // where on its line each ray meets the roof, from the axis
  std::array<std::vector<double>, kRoofSteps> off_m;  // off the plane that fits them best, by step
};

// None where no plane is square to the axis. A step that the sweep does not show is the rig file's.
std::optional<RoofLook> look_at_roof(const SweepReadings& readings, const RigGeometry& nominal,
                                     const MountingFit& fit);

double mean_deviation_m(const std::vector<double>& off_m);

}  // namespace swivel
