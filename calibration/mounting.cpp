#include "calibration/mounting.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"
#include "calibration/mounted_planes.hpp"

namespace swivel {
namespace {

constexpr std::size_t kFewestLines = 8;
constexpr std::size_t kFewestRays = 500;  // on planes
constexpr std::size_t kMostPlanes = 12;
constexpr std::size_t kPlaneSearches = 3;  // the better the mounting, the flatter the planes
constexpr int kMostSteps = 12;             // of each search
constexpr double kConverged = 1e-3;        // sigmas of a step
constexpr double kSteepestTilt = 0.98;     // sine: the scan plane would be square to the axis
constexpr double kFurthestSigmas = 4.0;    // of the prior
constexpr double kNamedShare = 0.05;       // of a value's variance, that is the prior's

// Both at once: the planes of the room, and what both views see where there is no plane.
class JointFit {
 public:
  JointFit(const SweepReadings& readings, const RigGeometry& nominal, const Unwanted& unwanted)
      : readings_(readings),
        nominal_(nominal),
        prior_(prior_of(nominal)),
        views_(views_of_lines(readings)),
        cell_m_(views_ ? finest_cell_m(readings, *views_) : 0.0),
        unwanted_(unwanted) {}

  void run(const MountingVector& start) {
    solution_.value = start;
    for (std::size_t search = 0; search < kPlaneSearches; ++search) {
      planes_ = find_sighted_planes(readings_, beams(), kMostPlanes);
      for (int step = 0; step < kMostSteps; ++step) {
        if (unwanted_()) return;
        if (take_step() < kConverged) break;
      }
    }
  }

  void fill(MountingFit& fit) const {
    fit.solution = solution_;
    fit.planes = planes_;
    fit.cells = cells_;
    double squares = 0.0;
    for (const SightedPlane& plane : planes_) {
      fit.rays += plane.rays;
      squares += static_cast<double>(plane.rays) * plane.range_sigma_m * plane.range_sigma_m;
    }
    if (fit.rays > 0) fit.residual_m = std::sqrt(squares / static_cast<double>(fit.rays));
  }

 private:
  MountedBeams beams() const { return {nominal_, solution_.value, readings_}; }

  // Returns its length in sigmas.
  double take_step() {
    const PlaneSightings sightings = sight_planes(readings_, beams(), planes_);
    MountingEquations equations = without_planes(sightings);
    if (views_) {
      const HalfScanCells overlap =
          compare_half_scans(readings_, *views_, sightings.explained, beams(), cell_m_);
      equations.add(overlap.equations);
      cells_ = overlap.cells;
    }
    const MountingSolution next = solve(equations, solution_.value, prior_);
    const MountingVector moved = next.value - solution_.value;
    planes_ = moved_planes(planes_, sightings, moved);
    solution_ = next;
    return std::sqrt(moved.dot(next.information * moved));
  }

  const SweepReadings& readings_;
  const RigGeometry& nominal_;
  MountingPrior prior_;
  std::optional<std::vector<View>> views_;
  double cell_m_;
  const Unwanted& unwanted_;
  MountingSolution solution_;
  std::vector<SightedPlane> planes_;
  std::size_t cells_ = 0;
};

std::vector<std::string> names_of_unseen(const MountingSolution& solution) {
  std::vector<std::string> names;
  for (std::size_t value = 0; value < kMountingNames.size(); ++value) {
    if (!is_seen(solution, static_cast<MountingValue>(value)))
      names.emplace_back(kMountingNames[value]);
  }
  names.insert(names.end(), {"rz", "tz"});
  return names;
}

std::string advice_for(const MountingSolution& solution, bool full_turn) {
  const auto unseen = [&](MountingValue value) { return !is_seen(solution, value); };
  std::string advice;
  if (unseen(kMountingTilt) || unseen(kMountingLeverX) || unseen(kMountingLeverY)) {
    advice =
        "a wall that the lidar sees besides roof and floor, better two of them, shows tilt and "
        "lever arm: sweep in another room";
  }
  if (unseen(kMountingBias)) {
    advice = "a roof, a floor or a wall in range shows the bias: sweep in another room";
  }
  if (!advice.empty() && !full_turn) advice += "; a full turn shows more than a part of one";
  return advice;
}

// The axis alone, the mounting as the rig file has it: what sweeps up and down show wherever they
// see the same.
bool take_hysteresis(const SweepReadings& readings, const RigGeometry& nominal, MountingFit& fit) {
  const MountingPrior whole = prior_of(nominal);
  MountingPrior prior{whole.nominal, MountingVector::Zero()};
  prior.sigma[kAxisHysteresis] = whole.sigma[kAxisHysteresis];
  fit.half_scans = fit_half_scans(readings, nominal, prior, prior.nominal);
  if (!fit.half_scans || fit.half_scans->solution.seen_directions == 0) return false;
  fit.solution = fit.half_scans->solution;
  fit.solution.covariance.diagonal() +=
      (whole.sigma - prior.sigma).cwiseAbs2();  // of what was not asked
  return true;
}

MountingVector start_of(const MountingFit& fit, const MountingPrior& prior) {
  MountingVector start = prior.nominal;
  if (fit.symmetric_rays.verified) start[kMountingBias] = fit.symmetric_rays.bias_rad;
  return start;
}

std::string why_unusable(const SweepReadings& readings, const RigGeometry& nominal) {
  if (readings.lines.size() < kFewestLines || readings.beams() < 2) {
    return in_words("the sweep has ", readings.lines.size(), " lines; at least ", kFewestLines,
                    " are needed");
  }
  if (std::abs(nominal.T_axis_lidar.linear()(2, 0)) > kSteepestTilt) {
    return "the rig's scan plane is square to the axis: turning it shows nothing new; check "
           "mounting.rpy_deg";
  }
  return {};
}

}  // namespace

bool is_seen(const MountingSolution& solution, MountingValue value) {
  return solution.unseen[value] <= kNamedShare;
}

bool shows_mounting(const MountingFit& fit) {
  return fit.unobservable.size() < kMountingNames.size() + 2;
}

MountingResult fit_mounting(const SweepReadings& readings, const RigGeometry& nominal,
                            const Unwanted& unwanted) {
  if (std::string reason = why_unusable(readings, nominal); !reason.empty())
    return {std::nullopt, std::move(reason)};
  const MountingPrior prior = prior_of(nominal);
  MountingFit fit;
  fit.symmetric_rays = fit_symmetric_rays(readings, nominal);
  MountingVector start = start_of(fit, prior);
  fit.half_scans = fit_half_scans(readings, nominal, prior, start);
  if (fit.half_scans) start = fit.half_scans->solution.value;
  JointFit joint(readings, nominal, unwanted);
  joint.run(start);
  if (unwanted()) return {std::nullopt, "cancelled"};
  joint.fill(fit);
  if (fit.rays < kFewestRays && fit.cells == 0) {
    return {std::nullopt,
            in_words("only ", fit.rays, " rays meet a flat surface: sweep in a room")};
  }
  fit.advice = advice_for(fit.solution, views_of_lines(readings).has_value());
  fit.unobservable = names_of_unseen(fit.solution);
  if (!shows_mounting(fit) && !take_hysteresis(readings, nominal, fit))
    return {std::nullopt, "the sweep shows nothing of the mounting: " + fit.advice};
  const auto far = (fit.solution.value - prior.nominal).cwiseAbs().array() >
                   kFurthestSigmas * prior.sigma.array();
  if (far.any()) {
    return {
        std::nullopt,
        "the fit ends far from the rig file: surfaces that are not flat, ranges that are off by "
        "their size, or the file of another rig"};
  }
  if (!fit.solution.value.allFinite() || !fit.solution.covariance.allFinite())
    return {std::nullopt, "the fit did not come to an end; is the rig file that of this rig?"};
  fit.geometry = with_mounting(nominal, fit.solution.value);
  fit.thickness = compare_thickness(readings, nominal, fit.solution.value);
  fit.apart = compare_apart(readings, nominal, fit.solution.value);
  return {std::move(fit), {}};
}

JointMounting join_mountings(const std::vector<MountingFit>& fits, const RigGeometry& nominal) {
  if (fits.size() == 1) return {fits.front(), {}};
  std::vector<MountingSolution> solutions;
  JointMounting joint;
  double squares = 0.0;
  bool full_turn = false;
  for (const MountingFit& fit : fits) {
    solutions.push_back(fit.solution);
    joint.fit.rays += fit.rays;
    joint.fit.cells += fit.cells;
    squares += static_cast<double>(fit.rays) * fit.residual_m * fit.residual_m;
    full_turn = full_turn || fit.half_scans.has_value();
  }
  joint.fit.solution = solve_together(solutions, prior_of(nominal));
  joint.fit.geometry = with_mounting(nominal, joint.fit.solution.value);
  joint.fit.unobservable = names_of_unseen(joint.fit.solution);
  joint.fit.advice = advice_for(joint.fit.solution, full_turn);
  if (joint.fit.rays > 0)
    joint.fit.residual_m = std::sqrt(squares / static_cast<double>(joint.fit.rays));
  joint.scatter.freedom = -joint.fit.solution.seen_directions;
  for (const MountingSolution& sweep : solutions) {
    const MountingVector off = sweep.value - joint.fit.solution.value;
    joint.scatter.sum += off.dot(sweep.information * off);
    joint.scatter.freedom += sweep.seen_directions;
  }
  return joint;
}

}  // namespace swivel
