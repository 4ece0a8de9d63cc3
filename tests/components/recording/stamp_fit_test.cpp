#include "components/recording/stamp_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace swivel {
namespace {

constexpr double kNominal_ns = 25e6;

// What a counter of milliseconds shows of lines that begin evenly.
std::vector<StampedLine> counted(double first_ns, double period_ns, int lines) {
  std::vector<StampedLine> stamped;
  stamped.reserve(static_cast<std::size_t>(lines));
  for (int line = 0; line < lines; ++line)
    stamped.push_back({line, std::floor((first_ns + line * period_ns) * 1e-6) * 1e6});
  return stamped;
}

TEST(StampFit, FindsThePeriodFarBelowTheTickOfTheCounter) {
  constexpr int trials = 200;
  double squares = 0.0;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> period_error(-0.003, 0.003), first_ns(0.0, 1e9);
  for (int trial = 0; trial < trials; ++trial) {
    const double period_ns = kNominal_ns * (1.0 + period_error(random));
    std::vector<std::vector<StampedLine>> sweeps;
    for (const int lines : {40, 40, 160})
      sweeps.push_back(counted(first_ns(random), period_ns, lines));
    const StampFit fit = fit_stamps(sweeps, kNominal_ns);
    const double error = fit.period_ns / period_ns - 1.0;
    // Worst where the period is so near to whole ticks that hardly a stamp tells.
    EXPECT_NEAR(error, 0.0, 4e-4);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / trials), 1e-4);  // of 180 deg: 0.018 deg
}

TEST(StampFit, EachSweepKeepsAStartOfItsOwn) {
  const StampFit fit = fit_stamps({counted(3e6, 26e6, 30), counted(500e6, 26e6, 20)}, kNominal_ns);
  ASSERT_EQ(fit.first_ns.size(), 2U);
  EXPECT_NEAR(fit.first_ns[0], 3e6, 1.0);
  EXPECT_NEAR(fit.first_ns[1], 500e6, 1.0);
}

TEST(StampFit, AMissingLineChangesNothing) {
  auto lines = counted(0.0, 26e6, 30);
  lines.erase(lines.begin() + 7, lines.begin() + 11);
  EXPECT_NEAR(fit_stamps({lines}, kNominal_ns).period_ns, 26e6, 1.0);
}

TEST(StampFit, OneLineASweepTellsNoPeriod) {
  const StampFit fit = fit_stamps({{{3, 80e6}}}, kNominal_ns);
  EXPECT_EQ(fit.period_ns, kNominal_ns);
  EXPECT_EQ(fit.first_ns[0], 5e6);
}

TEST(StampFit, TheResidualOfAWrongLineNumberIsAPeriod) {
  auto lines = counted(0.0, 25e6, 400);
  lines[200].number = 201;
  const StampFit fit = fit_stamps({lines}, kNominal_ns);
  EXPECT_NEAR(residual_ns(fit, 0, lines[200]), -25e6, 1e6);
}

}  // namespace
}  // namespace swivel
