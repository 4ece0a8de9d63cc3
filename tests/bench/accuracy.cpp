#include "tests/bench/accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "calibration/planes.hpp"
#include "calibration/plate_learning.hpp"
#include "tests/bench/on_all_cores.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr std::size_t kWallsLookedFor = 8;
constexpr std::uint64_t kCalibrationRun = 50;  // its sweeps are not those of the trials
constexpr std::size_t kMostCalibrationSweeps = 1000;

// The rig is the same one in all of them.
BenchSweepOptions sweep_of(Tier tier, int mode, std::uint64_t run, std::size_t sweep) {
  BenchSweepOptions options = drawn_sweep(tier, mode, run * 100'000 + sweep);
  options.world.plate.alpha_deg = deg_from_rad(PlateGeometry().alpha_rad);
  return options;
}

BenchSweepOptions sweep_of(const TrialPlan& plan, std::size_t sweep) {
  return sweep_of(plan.tier, plan.mode, plan.seed * 100 + static_cast<std::uint64_t>(plan.mode),
                  sweep);
}

BenchSweepOptions sweep_of(const CalibrationPlan& plan, std::size_t sweep) {
  const std::uint64_t run =
      plan.seed * 100 + kCalibrationRun + static_cast<std::uint64_t>(plan.mode);
  const std::size_t before = kMostCalibrationSweeps * static_cast<std::size_t>(plan.run);
  BenchSweepOptions options = sweep_of(plan.tier, plan.mode, run, before + sweep);
  options.world.room = room_of(plan.room);
  return options;
}

AttitudeTrial tried(const NamedEstimator& estimator, const BenchSweep& sweep) {
  const AttitudeEstimate estimate = estimator.estimate(sweep.cloud, estimator.plate);
  if (estimate.verdict != AttitudeVerdict::kGood) return {};
  const double phi_rad = phi_offset_rad(estimator.plate.alpha_rad, estimate.beta_rad);
  return {true, std::remainder(phi_rad - sweep.phi_start_rad, 2 * kPi),
          std::hypot(estimate.beta_sigma_rad, estimator.alpha_sigma_rad)};
}

// What a sweep brings to a calibration: its walls once, its plate by each estimator.
struct CalibrationSweep {
  std::vector<Plane> walls;
  std::vector<AttitudeEstimate> estimates;
};

CalibrationSweep looked_at(const BenchSweep& sweep, const std::vector<NamedEstimator>& estimators) {
  CalibrationSweep seen{find_walls(sweep.cloud, kWallsLookedFor), {}};
  for (const NamedEstimator& estimator : estimators) {
    seen.estimates.push_back(estimator.estimate(sweep.cloud, estimator.plate));
  }
  return seen;
}

Calibrated calibrated(const NamedEstimator& drawn, std::size_t which,
                      const std::vector<CalibrationSweep>& sweeps) {
  std::vector<AlphaSweep> told;
  std::vector<PlateFit> fits;
  for (const CalibrationSweep& sweep : sweeps) {
    const AttitudeEstimate& estimate = sweep.estimates[which];
    if (estimate.verdict != AttitudeVerdict::kGood) continue;
    told.push_back({estimate.beta_rad, estimate.beta_sigma_rad, sweep.walls, {}});
    if (estimate.fit) fits.push_back(*estimate.fit);
  }
  Calibrated found{drawn, {}};
  if (!fits.empty()) {
    const LearnedPlate learned = learn_plate(fits, drawn.plate.shape);
    found.estimator.plate.shape = learned.shape;
    for (std::size_t i = 0; i < told.size(); ++i) {
      told[i].beta_rad = learned.betas_rad[i].value;
      told[i].beta_sigma_rad = learned.betas_rad[i].sigma;
    }
  }
  found.alpha = fit_alpha(told);
  if (found.alpha.fit) {
    found.estimator.plate.alpha_rad = found.alpha.fit->alpha_rad;
    found.estimator.alpha_sigma_rad = found.alpha.fit->sigma_rad;
  }
  return found;
}

// Of the processor: other programs do not count.
double time_ms(const NamedEstimator& estimator, const BenchSweep& sweep) {
  const std::clock_t start = std::clock();
  (void)estimator.estimate(sweep.cloud, estimator.plate);
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

std::vector<NamedEstimator> known_estimators() {
  std::vector<NamedEstimator> known;
  for (const char* name : {"ring_mean", "plate_outline"}) {
    if (const auto estimator = attitude_estimator(name, yuans_rig())) {
      known.push_back({name, *estimator, {}, 0.0});
    }
  }
  return known;
}

AccuracySummary summarise(const std::vector<AttitudeTrial>& trials) {
  AccuracySummary summary;
  double squares = 0.0;
  double squares_in_sigmas = 0.0;
  for (const AttitudeTrial& trial : trials) {
    if (!trial.good) continue;
    ++summary.good;
    const double error_deg = deg_from_rad(trial.error_rad);
    summary.mean_deg += error_deg;
    summary.max_deg = std::max(summary.max_deg, std::abs(error_deg));
    squares += error_deg * error_deg;
    squares_in_sigmas += std::pow(trial.error_rad / trial.sigma_rad, 2);
  }
  summary.refused = trials.size() - summary.good;
  const auto count = static_cast<double>(std::max<std::size_t>(summary.good, 1));
  summary.mean_deg /= count;
  summary.rms_deg = std::sqrt(squares / count);
  summary.rms_in_sigmas = std::sqrt(squares_in_sigmas / count);
  return summary;
}

std::vector<Calibrated> calibrate(const CalibrationPlan& plan,
                                  const std::vector<NamedEstimator>& estimators) {
  std::vector<CalibrationSweep> sweeps(static_cast<std::size_t>(plan.sweeps));
  on_all_cores(sweeps.size(), [&](std::size_t index) {
    sweeps[index] = looked_at(make_bench_sweep(sweep_of(plan, index)), estimators);
  });
  std::vector<Calibrated> all;
  for (std::size_t each = 0; each < estimators.size(); ++each) {
    all.push_back(calibrated(estimators[each], each, sweeps));
  }
  return all;
}

std::vector<std::vector<AttitudeTrial>> run_trials(
    const TrialPlan& plan, const std::vector<std::vector<NamedEstimator>>& calibrations) {
  std::vector<std::vector<AttitudeTrial>> trials(
      calibrations.front().size(),
      std::vector<AttitudeTrial>(static_cast<std::size_t>(plan.sweeps)));
  on_all_cores(static_cast<std::size_t>(plan.sweeps), [&](std::size_t index) {
    BenchSweepOptions options = sweep_of(plan, index);
    options.plate_beams_only = true;
    const BenchSweep sweep = make_bench_sweep(options);
    const auto& estimators = calibrations[index % calibrations.size()];
    for (std::size_t each = 0; each < estimators.size(); ++each) {
      trials[each][index] = tried(estimators[each], sweep);
    }
  });
  return trials;
}

std::vector<double> median_times_ms(const TrialPlan& plan,
                                    const std::vector<NamedEstimator>& estimators) {
  const BenchSweep sweep = make_bench_sweep(sweep_of(plan, 0));
  std::vector<double> medians_ms;
  for (const NamedEstimator& estimator : estimators) {
    std::array<double, 7> times_ms{};
    for (double& each : times_ms) each = time_ms(estimator, sweep);
    const auto middle = times_ms.begin() + times_ms.size() / 2;
    std::nth_element(times_ms.begin(), middle, times_ms.end());
    medians_ms.push_back(*middle);
  }
  return medians_ms;
}

}  // namespace swivel
