// How the lidar stands on the axis: the bias of its centreline, the tilt of the scan plane and the
// lever arm, from sweeps of any rotating 2D lidar. docs/geometry.md (19) to (25); Zeng 2018.
//
// What it cannot see: a turn about the axis, a shift along it. The roll about the scan plane's
// normal is one with the bias.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/chi_square.hpp"
#include "calibration/half_scans.hpp"
#include "calibration/mounted_planes.hpp"
#include "calibration/mounting_equations.hpp"
#include "calibration/plane_sightings.hpp"
#include "calibration/symmetric_rays.hpp"

namespace swivel {

// Of the values of a mounting, as users know them.
inline constexpr std::array<const char*, 4> kMountingNames = {"bias", "ry", "tx", "ty"};

// All but a twentieth of the value's variance is what the data leave.
bool is_seen(const MountingSolution& solution, MountingValue value);

struct MountingFit {
  RigGeometry geometry;                   // the nominal with what was estimated in it
  MountingSolution solution;              // with covariance; the nominal where nothing is seen
  std::vector<std::string> unobservable;  // of bias, ry, tx, ty, and always rz and tz
  std::string advice;                     // what shows more of it; empty where all is seen
  std::size_t rays = 0;                   // on planes
  std::size_t cells = 0;                  // that both views see, where there is no plane
  double residual_m = 0.0;                // rms of ranges about the planes
  std::vector<SightedPlane> planes;       // of one sweep alone
  Thickness thickness;                    // likewise
  std::optional<ViewsApart> apart;        // likewise
  SymmetricRaysFit symmetric_rays;        // the steps of Zeng 2018, likewise
  std::optional<HalfScansFit> half_scans;

  double sigma_of(MountingValue value) const {
    return std::sqrt(solution.covariance(value, value));
  }
};

struct MountingResult {
  std::optional<MountingFit> fit;  // none: refused
  std::string reason;              // then in words what to do; else empty
};

// At least one of bias, ry, tx, ty is seen; else only the hysteresis of the axis.
bool shows_mounting(const MountingFit& fit);

// Asked now and then by a fit that takes seconds: whether nobody wants it any more.
using Unwanted = std::function<bool()>;

// From what was seen at one place: a sweep, or a sweep up and one down, one after the other.
MountingResult fit_mounting(
    const SweepReadings& readings, const RigGeometry& nominal,
    const Unwanted& unwanted = [] { return false; });

struct JointMounting {
  MountingFit fit;
  ChiSquare scatter;  // of the sweeps about it: not by chance where their mountings differ
};

// One mounting for all of them, at whatever place each was taken. fits: at least one.
JointMounting join_mountings(const std::vector<MountingFit>& fits, const RigGeometry& nominal);

}  // namespace swivel
