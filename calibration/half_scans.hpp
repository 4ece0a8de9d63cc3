// A full turn sees every surface twice, with either half of the scan plane: in its first half and
// in the half that follows. Where they differ the mounting is wrong (Alismail and Browning 2014;
// Zeng 2018). docs/geometry.md (22).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/mounting_equations.hpp"
#include "calibration/two_views.hpp"

namespace swivel {

// Which rays may speak: lines * beams, or empty for all.
using RayMask = std::vector<std::uint8_t>;

struct HalfScanCells {
  MountingEquations equations;
  std::size_t cells = 0;    // flat ones that both views see
  double residual_m = 0.0;  // rms distance of one view from the other
};

// Point to plane in cells of that size, normals from the points as the mounting puts them.
HalfScanCells compare_half_scans(const SweepReadings& readings, const std::vector<View>& views,
                                 const RayMask& left_out, const MountedBeams& beams, double cell_m);

// In which two views are compared at last: a small scene has small cells.
double finest_cell_m(const SweepReadings& readings, const std::vector<View>& views);

// How far one view lies from the other, rms over cells, under the rig file's mounting and under
// another.
struct ViewsApart {
  double nominal_m = 0.0;
  double mounted_m = 0.0;
};
// None where nothing is seen twice.
std::optional<ViewsApart> compare_apart(const SweepReadings& readings, const RigGeometry& nominal,
                                        const MountingVector& mounting);

struct HalfScansFit {
  MountingSolution solution;
  std::size_t cells = 0;
  double residual_m = 0.0;
};

// From coarse to fine. None where too little is seen twice.
std::optional<HalfScansFit> fit_half_scans(const SweepReadings& readings,
                                           const RigGeometry& nominal, const MountingPrior& prior,
                                           const MountingVector& start);

}  // namespace swivel
