// How well alpha is known, and whether it says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/alpha.hpp"
#include "tests/calibration/room_sweeps.hpp"

namespace swivel {
namespace {

std::vector<AlphaSweep> noisy_sweeps(std::size_t count, double sigma_deg, std::mt19937& random) {
  std::normal_distribution<double> beta_noise_deg(0.0, sigma_deg);
  std::normal_distribution<double> wall_noise_deg(0.0, 0.02);
  std::uniform_real_distribution<double> offset_deg(-5.0, 5.0);
  std::vector<AlphaSweep> sweeps;
  for (std::size_t sweep = 0; sweep < count; ++sweep) {
    sweeps.push_back(perfect_sweep(rad_from_deg(offset_deg(random))));
    sweeps.back().beta_rad += rad_from_deg(beta_noise_deg(random));
    sweeps.back().beta_sigma_rad = rad_from_deg(sigma_deg);
    for (Plane& plane : sweeps.back().walls) {
      plane = turned(plane, rad_from_deg(wall_noise_deg(random)));
      plane.azimuth_sigma_rad = rad_from_deg(0.02);
    }
  }
  return sweeps;
}

TEST(Alpha, SigmaIsHonestForFewSweepsAndForMany) {
  for (const std::size_t count : {1U, 2U, 3U, 5U, 20U}) {
    AlphaOptions options;
    options.least_sweeps = 1;
    std::mt19937 random(static_cast<unsigned>(count));
    double squares = 0.0;
    int within = 0;
    int doubted = 0;
    constexpr int kRuns = 300;
    for (int run = 0; run < kRuns; ++run) {
      const AlphaFit fit = fitted(noisy_sweeps(count, 0.08, random), options);
      const double errors_in_sigmas = (fit.alpha_rad - kAlphaRad) / fit.sigma_rad;
      squares += errors_in_sigmas * errors_in_sigmas;
      if (std::abs(errors_in_sigmas) < 1.0) ++within;
      if (!fit.model_holds) ++doubted;
    }
    EXPECT_GT(std::sqrt(squares / kRuns), 0.8) << count;
    EXPECT_LT(std::sqrt(squares / kRuns), 1.2) << count;
    EXPECT_GT(within, 0.60 * kRuns) << count;
    EXPECT_LT(within, 0.82 * kRuns) << count;
    EXPECT_LE(doubted, 3) << count;
  }
}

TEST(Alpha, ChiSquareIsAboutItsDegreesOfFreedomWhenTheSigmasAreTrue) {
  std::mt19937 random(9);
  double sum = 0.0;
  for (int run = 0; run < 100; ++run) {
    const AlphaFit fit = fitted(noisy_sweeps(5, 0.08, random));
    EXPECT_EQ(fit.degrees_of_freedom, 16U);  // 20 sightings, 4 angles
    sum += fit.chi_square;
  }
  EXPECT_NEAR(sum / 100, 16.0, 1.7);  // 3 sigmas of the mean
}

TEST(Alpha, ScatterAboveTheSweepsOwnSigmasWidensSigmaAndIsSaid) {
  std::mt19937 random(7);
  auto sweeps = noisy_sweeps(20, 0.3, random);
  for (AlphaSweep& sweep : sweeps) sweep.beta_sigma_rad = rad_from_deg(0.15);
  const AlphaFit fit = fitted(sweeps);
  EXPECT_GT(fit.sigma_rad, rad_from_deg(0.3 / std::sqrt(20.0) * 0.7));
  EXPECT_FALSE(fit.model_holds);
  EXPECT_NE(remarks_of(fit).find("plate's azimuths scatter"), std::string::npos);
}

TEST(Alpha, WallsThatMoveBetweenTheSweepsAreSaid) {
  std::mt19937 random(8);
  auto sweeps = noisy_sweeps(20, 0.08, random);
  for (AlphaSweep& sweep : sweeps) {
    for (Plane& plane : sweep.walls) plane.azimuth_sigma_rad = rad_from_deg(0.01);
  }
  const AlphaFit fit = fitted(sweeps);
  EXPECT_FALSE(fit.model_holds);
  EXPECT_NE(remarks_of(fit).find("walls' angles scatter"), std::string::npos) << remarks_of(fit);
}

// A sharp sweep counts for more: five of mode 1 and one of mode 7.
TEST(Alpha, SweepsOfAllModesMixByTheirSigmas) {
  std::mt19937 random(3);
  double squares = 0.0;
  double foretold_rad = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    auto sweeps = noisy_sweeps(5, 0.08, random);
    sweeps.push_back(noisy_sweeps(1, 0.016, random)[0]);
    const AlphaFit fit = fitted(sweeps);
    squares += std::pow(fit.alpha_rad - kAlphaRad, 2);
    foretold_rad = fit.sweeps_sigma_rad;
  }
  EXPECT_LT(std::sqrt(squares / kRuns), rad_from_deg(0.021));
  EXPECT_LT(foretold_rad, rad_from_deg(0.025));
}

TEST(Alpha, WallsOutOfSquareLimitSigmaHoweverManySweeps) {
  std::vector<AlphaSweep> sweeps(400, perfect_sweep(0.01));
  for (const std::size_t side : {0U, 1U, 2U, 3U}) {
    turn_wall(sweeps, side, rad_from_deg(side % 2 == 0 ? 0.06 : -0.06));
  }
  const AlphaFit fit = fitted(sweeps);
  EXPECT_GT(fit.sigma_rad, rad_from_deg(0.02));
  EXPECT_FALSE(more_sweeps_for(fit, rad_from_deg(0.02)));
}

TEST(Alpha, AsManyMoreSweepsAsItSaysBringTheWantedSigma) {
  const std::vector<AlphaSweep> few(5, perfect_sweep(0.01));
  const AlphaFit fit = fitted(few);
  for (const double wanted_deg : {0.05, 0.02, 0.011}) {
    const auto more = more_sweeps_for(fit, rad_from_deg(wanted_deg));
    ASSERT_TRUE(more);
    const std::vector<AlphaSweep> enough(5 + *more, perfect_sweep(0.01));
    const std::vector<AlphaSweep> too_few(4 + *more, perfect_sweep(0.01));
    EXPECT_LE(fitted(enough).sigma_rad, rad_from_deg(wanted_deg) * (1 + 1e-9));
    EXPECT_GT(fitted(too_few).sigma_rad, rad_from_deg(wanted_deg));
  }
  EXPECT_EQ(more_sweeps_for(fit, fit.sigma_rad), 0U);
}

}  // namespace
}  // namespace swivel
