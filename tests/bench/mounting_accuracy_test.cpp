// What is promised of the mounting's sigma and of the roof, over several rigs and two rooms. In
// release alone: the sanitizers see the same code in calibration_test.
#include <gtest/gtest.h>

#include "tests/bench/mounting_trials.hpp"

namespace swivel {
namespace {

TEST(MountingAccuracy, SigmasAreHonest) {
  constexpr std::uint64_t kRigs = 10;
  constexpr std::size_t kLines = 40;
  std::vector<PanScan> scans;
  for (std::uint64_t seed = 1; seed <= kRigs; ++seed)
    scans.push_back(drawn_pan_scan(kPanRooms.at(seed % 2), seed, kLines));
  const std::vector<MountingTrial> trials = run_mounting_trials(scans);
  double squares = 0.0;
  for (const MountingValue value :
       {kMountingBias, kMountingTilt, kMountingLeverX, kMountingLeverY}) {
    const ErrorsOfValue errors = errors_of(trials, value);
    ASSERT_EQ(errors.found, kRigs);
    squares += errors.rms_in_sigmas * errors.rms_in_sigmas;
  }
  EXPECT_GT(std::sqrt(squares / 4.0), 0.75);
  EXPECT_LT(std::sqrt(squares / 4.0), 1.25);
}

TEST(MountingAccuracy, TheRoofIsAsFlatAsTheNoiseLeavesItAndNoStepAloneMakesItSo) {
  for (const PanRoom room : kPanRooms) {
    PanScan scan = drawn_pan_scan(room, 1, 90);
    scan.bias_deg = 3.75;
    const auto trial = try_roof(scan);
    ASSERT_TRUE(trial);
    EXPECT_GT(trial->steps_m[0], 4.0 * trial->noise_m);
    EXPECT_GT(trial->steps_m[1], 2.0 * trial->noise_m) << "half scans alone leave the bias";
    EXPECT_NEAR(trial->steps_m[3], trial->noise_m, 0.03 * trial->noise_m);
  }
}

}  // namespace
}  // namespace swivel
