// How far off the attitude is: Monte Carlo over sweeps of the bench's world, without wires and
// without DDS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/attitude.hpp"
#include "tests/support/bench_sweep.hpp"

namespace swivel {

struct NamedEstimator {
  std::string name;
  AttitudeEstimator estimate;
};

// Those that there are, the paper's first.
std::vector<NamedEstimator> known_estimators();

struct AttitudeTrial {
  bool good = false;       // else the sweep was refused
  double error_rad = 0.0;  // beta less the truth
  double sigma_rad = 0.0;  // as the estimator says
};

struct AccuracySummary {
  std::size_t good = 0;
  std::size_t refused = 0;
  double mean_deg = 0.0;  // what alpha would absorb
  double rms_deg = 0.0;
  double max_deg = 0.0;
  double rms_in_sigmas = 0.0;  // 1 when sigma is honest
};

AccuracySummary summarise(const std::vector<AttitudeTrial>& trials);

struct TrialPlan {
  Tier tier = Tier::kReal;
  int mode = 1;
  int sweeps = 50;
  std::uint64_t seed = 1;
};

// A row of trials for each estimator; all see the same sweeps. Takes all cores.
std::vector<std::vector<AttitudeTrial>> run_trials(const TrialPlan& plan,
                                                   const std::vector<NamedEstimator>& estimators);

// Of the processor, for one estimate of a sweep with all its beams.
std::vector<double> median_times_ms(const TrialPlan& plan,
                                    const std::vector<NamedEstimator>& estimators);

}  // namespace swivel
