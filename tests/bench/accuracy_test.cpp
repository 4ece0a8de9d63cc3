// What the accuracy benchmark prints, against figures worked out by hand.
#include "tests/bench/accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/units.hpp"

namespace swivel {
namespace {

TEST(Accuracy, SummarisesWhatWasNotRefused) {
  const auto trial = [](double error_deg, double sigma_deg) {
    return AttitudeTrial{true, rad_from_deg(error_deg), rad_from_deg(sigma_deg)};
  };
  const AccuracySummary summary =
      summarise({trial(3.0, 1.0), AttitudeTrial(), trial(-4.0, 4.0), trial(0.0, 1.0)});
  EXPECT_EQ(summary.good, 3U);
  EXPECT_EQ(summary.refused, 1U);
  EXPECT_NEAR(summary.mean_deg, -1.0 / 3.0, 1e-12);
  EXPECT_NEAR(summary.rms_deg, std::sqrt(25.0 / 3.0), 1e-12);
  EXPECT_NEAR(summary.max_deg, 4.0, 1e-12);
  EXPECT_NEAR(summary.rms_in_sigmas, std::sqrt(10.0 / 3.0), 1e-12);
  EXPECT_EQ(summarise({AttitudeTrial()}).good, 0U);
}

// The truth and the estimators agree on frames and signs: without faults little is left.
TEST(Accuracy, TrialsAreJudgedByTheTruth) {
  const auto trials = run_trials({Tier::kClean, 4, 8, 3}, {known_estimators()});
  ASSERT_FALSE(trials.empty());
  for (const auto& row : trials) {
    const AccuracySummary summary = summarise(row);
    EXPECT_EQ(summary.refused, 0U);
    EXPECT_LT(summary.rms_deg, 0.6);
  }
  // The same seed gives the same sweeps, whichever thread casts them.
  const auto again = run_trials({Tier::kClean, 4, 8, 3}, {known_estimators()});
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(trials[0][i].error_rad, again[0][i].error_rad);
  EXPECT_NE(trials[0][0].error_rad, trials[0][1].error_rad);
}

TEST(Accuracy, SweepsTakeTurnsWithTheCalibrations) {
  auto turned = known_estimators();
  for (NamedEstimator& each : turned) each.plate.alpha_rad += 0.1;
  const TrialPlan plan{Tier::kClean, 1, 4, 3};
  const auto trials = run_trials(plan, {known_estimators(), turned});
  const auto unturned = run_trials(plan, {known_estimators()});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::abs(trials[0][i].error_rad - unturned[0][i].error_rad), i % 2 == 0 ? 0.0 : 0.1,
                1e-9);
  }
}

// A calibration on the bench finds the alpha that the sweeps were made with; what it found is what
// the trials then use.
TEST(Accuracy, ACalibrationFindsAlphaAndThePlate) {
  const auto all = calibrate({Tier::kReal, Room::kSquare, 2, 4, 3}, known_estimators());
  ASSERT_EQ(all.size(), known_estimators().size());
  const Calibrated& outline = all.back();
  ASSERT_TRUE(outline.alpha.fit) << outline.alpha.reason;
  EXPECT_EQ(outline.estimator.plate.alpha_rad, outline.alpha.fit->alpha_rad);
  EXPECT_LT(std::abs(outline.alpha.fit->alpha_rad - PlateGeometry().alpha_rad),
            5.0 * outline.alpha.fit->sigma_rad);
  EXPECT_LT(outline.estimator.plate.shape.growth_m.sigma, PlateShape().growth_m.sigma / 5.0);
  const auto next = calibrate({Tier::kReal, Room::kSquare, 2, 4, 3, 1}, known_estimators());
  EXPECT_NE(next.back().estimator.plate.alpha_rad, outline.estimator.plate.alpha_rad);
}

// What makes the benchmark quick must not change what it measures.
TEST(Accuracy, TheLowBeamsTellAllThatTheEstimatorsNeed) {
  BenchSweepOptions options = drawn_sweep(Tier::kReal, 3, 5);
  const BenchSweep whole = make_bench_sweep(options);
  options.plate_beams_only = true;
  const BenchSweep low = make_bench_sweep(options);
  for (const NamedEstimator& estimator : known_estimators()) {
    const AttitudeEstimate of_whole = estimator.estimate(whole.cloud, PlateGeometry());
    const AttitudeEstimate of_low = estimator.estimate(low.cloud, PlateGeometry());
    ASSERT_EQ(of_whole.verdict, AttitudeVerdict::kGood) << of_whole.reason;
    EXPECT_NEAR(of_low.beta_rad, of_whole.beta_rad, 0.1 * of_whole.beta_sigma_rad);
  }
}

}  // namespace
}  // namespace swivel
