// How far off a mounting is: Monte Carlo over sweeps of Zeng's rig in the bench's world, without
// wires and without DDS.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibration/mounting.hpp"
#include "calibration/roof_steps.hpp"
#include "tests/calibration/pan_scan.hpp"

namespace swivel {

// Roof at 2 m. The first is furnished; the second is larger, stands askew, and lamps hang from its
// roof.
enum class PanRoom { kFurnished, kWithLamps };
inline constexpr std::array<PanRoom, 2> kPanRooms = {PanRoom::kFurnished, PanRoom::kWithLamps};
const char* name_of(PanRoom room);

// A rig with a mounting of its own: bias within 5 deg, tilt within 0.6 deg, lever arm within 30 mm.
PanScan drawn_pan_scan(PanRoom room, std::uint64_t seed, std::size_t lines);

struct MountingTrial {
  PanScan scan;
  MountingResult result;
  double fit_s = 0.0;  // of the thread's processor time

  double error(MountingValue value) const;
};

// fit_mounting of each scan, from the identity as rig file. Takes all cores.
std::vector<MountingTrial> run_mounting_trials(const std::vector<PanScan>& scans);

struct ErrorsOfValue {
  std::size_t found = 0;
  double rms = 0.0;
  double largest = 0.0;
  double rms_in_sigmas = 0.0;  // 1 when sigma is honest
};
ErrorsOfValue errors_of(const std::vector<MountingTrial>& trials, MountingValue value);

// Mean distance of the roof's points from their plane under each step, and under the truth.
struct RoofTrial {
  std::array<double, kRoofSteps> steps_m{};
  double noise_m = 0.0;
};
std::optional<RoofTrial> try_roof(const PanScan& scan);

}  // namespace swivel
