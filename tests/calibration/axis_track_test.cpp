#include "calibration/axis_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace swivel {
namespace {

constexpr std::int64_t kEpochNs = 1'790'000'000'000'000'000;  // double has 256 ns left here

AxisTrack track_of(const std::vector<AxisSample>& samples) {
  AxisTrack track;
  for (const AxisSample& sample : samples) EXPECT_EQ(track.add(sample), AxisAdded::kAdded);
  return track;
}

std::vector<AxisSample> random_samples(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> step_ns(1, 40'000'000);
  std::uniform_real_distribution<double> angle_rad(-4.0, 4.0);
  std::vector<AxisSample> samples;
  std::int64_t time_ns = kEpochNs;
  for (int sample = 0; sample < count; ++sample) {
    samples.push_back({time_ns, angle_rad(random)});
    time_ns += step_ns(random);
  }
  return samples;
}

// Every pair of neighbours is tried: nothing to get wrong.
std::optional<double> brute_force(const std::vector<AxisSample>& samples, std::int64_t time_ns) {
  for (std::size_t after = 1; after < samples.size(); ++after) {
    const AxisSample a = samples[after - 1];
    const AxisSample b = samples[after];
    if (time_ns < a.time_ns || time_ns > b.time_ns) continue;
    const double part =
        static_cast<double>(time_ns - a.time_ns) / static_cast<double>(b.time_ns - a.time_ns);
    return (1.0 - part) * a.angle_rad + part * b.angle_rad;
  }
  return std::nullopt;
}

TEST(AxisTrack, AgreesWithBruteForceInsideAndOutside) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const auto samples = random_samples(seed, 40);
    const AxisTrack track = track_of(samples);
    const std::int64_t length_ns = samples.back().time_ns - kEpochNs;
    for (std::int64_t step = -20; step <= 1020; ++step) {
      const std::int64_t time_ns = kEpochNs + length_ns / 1000 * step;
      const auto expected = brute_force(samples, time_ns);
      const auto angle_rad = track.angle_at(time_ns);
      ASSERT_EQ(angle_rad.has_value(), expected.has_value()) << step;
      EXPECT_EQ(track.covers(time_ns, time_ns), expected.has_value());
      if (expected) {
        EXPECT_NEAR(*angle_rad, *expected, 1e-12);
      }
    }
  }
}

TEST(AxisTrack, IsExactOnItsSamplesTheEndsIncluded) {
  const auto samples = random_samples(9, 30);
  const AxisTrack track = track_of(samples);
  for (const AxisSample& sample : samples) {
    EXPECT_EQ(track.angle_at(sample.time_ns), sample.angle_rad);
  }
  EXPECT_FALSE(track.angle_at(samples.front().time_ns - 1));
  EXPECT_FALSE(track.angle_at(samples.back().time_ns + 1));
}

TEST(AxisTrack, RefusesWhatDoesNotComeLaterAndWhatIsNoNumber) {
  AxisTrack track = track_of({{100, 1.0}, {200, 2.0}});
  EXPECT_EQ(track.add({200, 7.0}), AxisAdded::kSameTime);
  EXPECT_EQ(track.add({199, 7.0}), AxisAdded::kBackwards);
  EXPECT_EQ(track.add({300, std::nan("")}), AxisAdded::kNotFinite);
  EXPECT_EQ(track.add({300, std::numeric_limits<double>::infinity()}), AxisAdded::kNotFinite);
  EXPECT_EQ(track.size(), 2U);
  EXPECT_EQ(track.angle_at(150), 1.5);
  EXPECT_FALSE(track.angle_at(250));
}

TEST(AxisTrack, AStraightStretchIsOneSegmentHoweverManySamplesItHas) {
  const double rate_rad_s = 3.1;
  AxisTrack track;
  for (int step = 0; step <= 100; ++step) {
    const std::int64_t time_ns = kEpochNs + std::int64_t{10'000'000} * step;
    ASSERT_EQ(track.add({time_ns, -0.3 + rate_rad_s * 0.01 * step}), AxisAdded::kAdded);
  }
  const auto segment = track.segment_over(kEpochNs + 33'333'333, kEpochNs + 777'777'777);
  ASSERT_TRUE(segment);
  EXPECT_NEAR(segment->rate_rad_s, rate_rad_s, 1e-9);
  EXPECT_NEAR(segment->start_angle_rad, -0.3 + rate_rad_s * 0.033333333, 1e-9);
}

TEST(AxisTrack, ABendInsideIsNoSegmentABendAtTheEndsIs) {
  const AxisTrack track = track_of({{0, 0.0}, {1000, 1.0}, {2000, 1.5}, {3000, 1.5}});
  EXPECT_TRUE(track.segment_over(0, 1000));
  EXPECT_TRUE(track.segment_over(1000, 2000));
  EXPECT_FALSE(track.segment_over(999, 1002));
  EXPECT_FALSE(track.segment_over(0, 3000));
  EXPECT_EQ(track.segment_over(2000, 3000)->rate_rad_s, 0.0);
}

TEST(AxisTrack, NoSegmentWhereItDoesNotCoverOrNothingElapses) {
  const AxisTrack track = track_of({{0, 0.0}, {1000, 1.0}});
  EXPECT_FALSE(track.segment_over(-1, 500));
  EXPECT_FALSE(track.segment_over(500, 1001));
  EXPECT_FALSE(track.segment_over(500, 500));
  EXPECT_FALSE(track.segment_over(600, 500));
  EXPECT_FALSE(AxisTrack().segment_over(0, 1));
}

TEST(AxisTrack, ForgettingChangesNothingThatIsLater) {
  const auto samples = random_samples(3, 50);
  for (std::size_t cut = 0; cut + 1 < samples.size(); ++cut) {
    AxisTrack track = track_of(samples);
    const std::int64_t time_ns = (samples[cut].time_ns + samples[cut + 1].time_ns) / 2;
    track.forget_before(time_ns);
    EXPECT_EQ(track.size(), samples.size() - cut);
    EXPECT_NEAR(*track.angle_at(time_ns), *brute_force(samples, time_ns), 1e-12);
    EXPECT_EQ(track.angle_at(samples.back().time_ns), samples.back().angle_rad);
  }
}

TEST(AxisTrack, ForgettingEverythingStillKnowsWhatCameLast) {
  AxisTrack track = track_of({{100, 1.0}, {200, 2.0}});
  track.forget_before(1000);
  EXPECT_EQ(track.size(), 1U);
  EXPECT_EQ(track.add({150, 0.0}), AxisAdded::kBackwards);
  AxisTrack empty;
  empty.forget_before(0);
  EXPECT_EQ(empty.size(), 0U);
}

TEST(AxisTrack, TheExtremesOfTimeDoNotOverflow) {
  const AxisTrack track = track_of({{std::numeric_limits<std::int64_t>::min(), 0.0},
                                    {std::numeric_limits<std::int64_t>::max(), 1.0}});
  EXPECT_NEAR(*track.angle_at(0), 0.5, 1e-9);
}

}  // namespace
}  // namespace swivel
