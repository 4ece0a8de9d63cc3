#include "tests/bench/accuracy.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <ctime>
#include <thread>

#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

BenchSweepOptions sweep_of(const TrialPlan& plan, int sweep) {
  const auto run = plan.seed * 100 + static_cast<std::uint64_t>(plan.mode);
  return drawn_sweep(plan.tier, plan.mode, run * 100'000 + static_cast<std::uint64_t>(sweep));
}

AttitudeTrial tried(const NamedEstimator& estimator, const BenchSweep& sweep) {
  const AttitudeEstimate estimate = estimator.estimate(sweep.cloud, PlateGeometry());
  if (estimate.verdict != AttitudeVerdict::kGood) return {};
  return {true, std::remainder(estimate.beta_rad - sweep.beta_rad, 2 * kPi),
          estimate.beta_sigma_rad};
}

// Of the processor: other programs do not count.
double time_ms(const NamedEstimator& estimator, const BenchSweep& sweep) {
  const std::clock_t start = std::clock();
  (void)estimator.estimate(sweep.cloud, PlateGeometry());
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

std::vector<NamedEstimator> known_estimators() {
  std::vector<NamedEstimator> known;
  for (const char* name : {"ring_mean", "plate_outline"}) {
    if (const auto estimator = attitude_estimator(name, yuans_rig())) {
      known.push_back({name, *estimator});
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

std::vector<std::vector<AttitudeTrial>> run_trials(const TrialPlan& plan,
                                                   const std::vector<NamedEstimator>& estimators) {
  std::vector<std::vector<AttitudeTrial>> trials(
      estimators.size(), std::vector<AttitudeTrial>(static_cast<std::size_t>(plan.sweeps)));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int index = next++; index < plan.sweeps; index = next++) {
      BenchSweepOptions options = sweep_of(plan, index);
      options.plate_beams_only = true;
      const BenchSweep sweep = make_bench_sweep(options);
      for (std::size_t each = 0; each < estimators.size(); ++each) {
        trials[each][static_cast<std::size_t>(index)] = tried(estimators[each], sweep);
      }
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    workers.emplace_back(work);
  }
  for (std::thread& worker : workers) worker.join();
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
