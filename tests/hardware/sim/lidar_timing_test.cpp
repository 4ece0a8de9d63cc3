#include "hardware/sim/lidar_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace swivel::sim {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'123'456'789;

LidarTiming timing_of(const LidarTimingOptions& options) {
  return {options, kStartNs, 1440, 1080, 1};
}

TEST(LidarTiming, TurnsWithItsTruePeriod) {
  const LidarTiming timing = timing_of({});
  EXPECT_EQ(timing.beam0_time_ns(0), kStartNs);
  EXPECT_EQ(timing.beam0_time_ns(1000) - kStartNs, 25'040'000'000);
  EXPECT_NEAR(timing.beam_period_ns() * 1440, 25.04e6, 1e-6);
}

TEST(LidarTiming, NextScanBeginsAtTheTimeOrLater) {
  const LidarTiming timing = timing_of({});
  EXPECT_EQ(timing.next_scan(kStartNs - 5), 0U);
  EXPECT_EQ(timing.next_scan(timing.beam0_time_ns(77)), 77U);
  EXPECT_EQ(timing.next_scan(timing.beam0_time_ns(77) + 1), 78U);
}

TEST(LidarTiming, StampsAreTheCounterAtTheFirstBeamAndWrapAt24Bits) {
  LidarTimingOptions options;
  options.stamp_start_ms = 16777216.0 - 100.0;
  options.clock_gain_ppm = 0.0;
  const LidarTiming timing = timing_of(options);
  EXPECT_EQ(timing.stamp_ms(0), 16777116U);
  EXPECT_EQ(timing.stamp_ms(3), 16777191U);  // 75.12 ms later
  EXPECT_EQ(timing.stamp_ms(4), 0U);         // 100.16
  EXPECT_EQ(timing.stamp_ms(8), 100U);       // 200.32
}

TEST(LidarTiming, CounterRunsFastByItsGain) {
  LidarTimingOptions options;
  options.stamp_start_ms = 0.0;
  options.clock_gain_ppm = 1000.0;
  EXPECT_EQ(timing_of(options).counter_ms(kStartNs + 100'000'500'000), 100'100U);
}

TEST(LidarTiming, RearCentreIsAnEighthOfATurnEarlier) {
  LidarTimingOptions options;
  options.stamp_start_ms = 1000.5;
  options.clock_gain_ppm = 0.0;
  options.scan_period_ms = 25.0;
  EXPECT_EQ(timing_of(options).stamp_ms(0), 1000U);
  options.stamp_at_rear_centre = true;
  EXPECT_EQ(timing_of(options).stamp_ms(0), 997U);  // 3.125 ms
}

TEST(LidarTiming, SendsOnTheTickAfterTheLastBeamAndInOrder) {
  const LidarTimingOptions options;
  const LidarTiming timing = timing_of(options);
  std::int64_t before_ns = 0;
  for (std::uint64_t scan = 0; scan < 500; ++scan) {
    const std::int64_t sent_ns = timing.send_time_ns(scan);
    const double after_last_ms =
        static_cast<double>(sent_ns - timing.beam0_time_ns(scan)) * 1e-6 - 18.78;
    ASSERT_GE(after_last_ms, 0.4);
    ASSERT_LE(after_last_ms, 1.8);
    const double in_tick_ms = std::fmod(static_cast<double>(sent_ns - kStartNs) * 1e-6, 1.0);
    ASSERT_GE(in_tick_ms, 0.399);
    ASSERT_LE(in_tick_ms, 0.801);
    ASSERT_GT(sent_ns, before_ns);
    before_ns = sent_ns;
  }
}

TEST(LidarTiming, ResetStartsTheCounterAnew) {
  LidarTiming timing = timing_of({});
  timing.reset_counter(kStartNs + 5'000'000'000);
  EXPECT_EQ(timing.counter_ms(kStartNs + 5'007'500'000), 7U);
}

}  // namespace
}  // namespace swivel::sim
