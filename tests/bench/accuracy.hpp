// How far off the attitude is: Monte Carlo over sweeps of the bench's world, without wires and
// without DDS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/alpha.hpp"
#include "calibration/attitude.hpp"
#include "tests/support/bench_sweep.hpp"

namespace swivel {

struct NamedEstimator {
  std::string name;
  AttitudeEstimator estimate;
  PlateGeometry plate;           // as drawn, and its alpha true; or as a calibration found both
  double alpha_sigma_rad = 0.0;  // of that calibration
};

// Those that there are, the paper's first.
std::vector<NamedEstimator> known_estimators();

struct AttitudeTrial {
  bool good = false;       // else the sweep was refused
  double error_rad = 0.0;  // of phi_offset
  double sigma_rad = 0.0;  // as it is said: of beta and alpha together
};

struct AccuracySummary {
  std::size_t good = 0;
  std::size_t refused = 0;
  double mean_deg = 0.0;
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

struct CalibrationPlan {
  Tier tier = Tier::kReal;
  Room room = Room::kCluttered;
  int mode = 7;
  int sweeps = 10;
  std::uint64_t seed = 1;
  int run = 0;  // the seed's first calibration, its second, ...
};

// The whole chain of `swivel calibrate alpha`: each estimator with the plate that it learns from
// those sweeps, and the alpha that the room's walls then tell; or why there is none.
struct Calibrated {
  NamedEstimator estimator;
  AlphaResult alpha;
};
std::vector<Calibrated> calibrate(const CalibrationPlan& plan,
                                  const std::vector<NamedEstimator>& estimators);

// A row of trials for each estimator; all see the same sweeps. The sweeps take turns with the
// calibrations, each of which has all estimators: a calibration's error is as random as a sweep's,
// and all the sweeps after it share it. Takes all cores.
std::vector<std::vector<AttitudeTrial>> run_trials(
    const TrialPlan& plan, const std::vector<std::vector<NamedEstimator>>& calibrations);

// Of the processor, for one estimate of a sweep with all its beams.
std::vector<double> median_times_ms(const TrialPlan& plan,
                                    const std::vector<NamedEstimator>& estimators);

}  // namespace swivel
