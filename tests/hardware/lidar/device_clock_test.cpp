#include "hardware/lidar/device_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace swivel {
namespace {

constexpr double kPeriodMs = 25.04;  // measured on real sensors: 25.036 to 25.043
constexpr double kGain = 1.00003;    // the computer's clock against the sensor's
constexpr double kLatencyMs = 0.125 * kPeriodMs + 0.75 * kPeriodMs + 0.5;
constexpr std::int64_t kEpochNs = 1'750'000'000'000'000'000;

struct SimulatedLine {
  std::uint32_t stamp_ms = 0;
  std::int64_t arrival_ns = 0;
  std::int64_t beam0_ns = 0;  // the truth
};

// Knows when everything happens; the clock under test is told stamps and arrivals only.
class Sensor {
 public:
  explicit Sensor(unsigned seed, double first_stamp_ms = 1000.0)
      : random_(seed), start_ms_(first_stamp_ms + uniform(0.0, 1.0)) {}

  SimulatedLine line(int number) {
    const double device_ms = start_ms_ + number * kPeriodMs;
    const double beam0_ms = device_ms + 0.125 * kPeriodMs;
    const double delay_ms = std::abs(0.3 * normal_(random_)) + (uniform(0, 1) < 0.03 ? 5.0 : 0.0);
    SimulatedLine line;
    line.stamp_ms = static_cast<std::uint32_t>(std::floor(device_ms)) & 0xFFFFFF;
    line.beam0_ns = computer_ns(beam0_ms);
    line.arrival_ns = computer_ns(device_ms) + std::llround((kLatencyMs + delay_ms) * 1e6);
    return line;
  }

  // As answered to TM1 `before_ms` before line 0; up to 1 ms there and back.
  void round_trip(DeviceClock& clock, double before_ms) {
    const double read_ms = start_ms_ - before_ms;
    const auto stamp = static_cast<std::uint32_t>(std::floor(read_ms)) & 0xFFFFFF;
    const auto there = std::llround(uniform(0.3, 0.6) * 1e6);
    const auto back = std::llround(uniform(0.3, 0.6) * 1e6);
    clock.add_round_trip(stamp, computer_ns(read_ms) - there, computer_ns(read_ms) + back);
  }

  std::int64_t computer_ns(double device_ms) const {
    return kEpochNs + std::llround((device_ms - start_ms_) * kGain * 1e6);
  }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double start_ms_;
};

struct Sweep {
  double jitter_ms = 0.0;  // rms about the sweep's mean error
  double mean_ms = 0.0;
};

Sweep statistics(const std::vector<double>& errors_ms) {
  Sweep sweep;
  for (const double error : errors_ms) sweep.mean_ms += error / errors_ms.size();
  for (const double error : errors_ms)
    sweep.jitter_ms += std::pow(error - sweep.mean_ms, 2) / errors_ms.size();
  sweep.jitter_ms = std::sqrt(sweep.jitter_ms);
  return sweep;
}

// The errors of lines [first, first + 40), after all before them were fed.
Sweep sweep_after(DeviceClock& clock, Sensor& sensor, int first) {
  std::vector<double> errors_ms;
  for (int number = 0; number < first + 40; ++number) {
    const SimulatedLine line = sensor.line(number);
    const LineTime time = clock.add(line.stamp_ms, line.arrival_ns);
    if (number >= first)
      errors_ms.push_back(static_cast<double>(time.beam0_time_ns - line.beam0_ns) * 1e-6);
  }
  return statistics(errors_ms);
}

// Sorted, of one sweep a seed.
template <class Measure>
std::vector<double> over_seeds(Measure measure) {
  std::vector<double> values;
  for (unsigned seed = 0; seed < 20; ++seed) values.push_back(measure(seed));
  std::sort(values.begin(), values.end());
  return values;
}

void tell(const char* what, const std::vector<double>& sorted, const char* unit) {
  std::printf("  %s: median %.4f %s, worst %.4f %s\n", what, sorted[sorted.size() / 2], unit,
              sorted.back(), unit);
}

void stream(DeviceClock& clock, Sensor& sensor, int first, int end) {
  for (int number = first; number < end; ++number) {
    const SimulatedLine line = sensor.line(number);
    clock.add(line.stamp_ms, line.arrival_ns);
  }
}

// 0.1 ms is 0.018 deg at 180 deg/s; it comes out far better.
TEST(DeviceClock, TimesOfASweepAreSmoothOnceAFewHundredLinesHaveStreamed) {
  for (const int first : {200, 400, 1200}) {
    const auto jitters_ms = over_seeds([&](unsigned seed) {
      Sensor sensor(seed);
      DeviceClock clock({});
      return sweep_after(clock, sensor, first).jitter_ms;
    });
    tell(("rms within a sweep after " + std::to_string(first) + " lines").c_str(), jitters_ms,
         "ms");
    EXPECT_LT(jitters_ms.back(), 0.02) << "after " << first << " lines";
  }
}

// The first lines tell little of the offset: a late one tells wrong by as much as it was late.
// Round trips make up for it.
TEST(DeviceClock, FortyLinesInAllHaveTimesToo) {
  const auto jitters_ms = over_seeds([](unsigned seed) {
    Sensor sensor(seed);
    DeviceClock clock({});
    return sweep_after(clock, sensor, 0).jitter_ms;
  });
  tell("rms of the first 40 lines", jitters_ms, "ms");
  EXPECT_LT(jitters_ms[jitters_ms.size() / 2], 0.3);
  const auto with_round_trips_ms = over_seeds([](unsigned seed) {
    Sensor sensor(seed);
    DeviceClock clock({});
    for (int trip = 0; trip < 20; ++trip) sensor.round_trip(clock, 100.0 - 2.3 * trip);
    return sweep_after(clock, sensor, 0).jitter_ms;
  });
  tell("rms of the first 40 lines after round trips", with_round_trips_ms, "ms");
  EXPECT_LT(with_round_trips_ms.back(), 0.25);
}

TEST(DeviceClock, ThePeriodIsFoundToAFewPartsInAMillion) {
  const auto errors_ppm = over_seeds([](unsigned seed) {
    Sensor sensor(seed);
    DeviceClock clock({});
    stream(clock, sensor, 0, 800);
    return std::abs(clock.scan_period_ns() / (kPeriodMs * kGain * 1e6) - 1.0) * 1e6;
  });
  tell("error of the period after 800 lines", errors_ppm, "ppm");
  EXPECT_LT(errors_ppm.back(), 10.0);
}

// The latency that is assumed is wrong by 3 ms here: round trips find that out.
TEST(DeviceClock, RoundTripsGiveTheOffsetWhateverTheLatency) {
  DeviceClockOptions options;
  options.transport_latency_ns = 3.5e6;
  const auto with_ms = over_seeds([&](unsigned seed) {
    Sensor sensor(seed);
    DeviceClock clock(options);
    for (int trip = 0; trip < 20; ++trip) sensor.round_trip(clock, 100.0 - 2.3 * trip);
    const double error_ms = std::abs(sweep_after(clock, sensor, 1000).mean_ms);
    EXPECT_TRUE(clock.quality().offset_from_round_trips);
    return error_ms;
  });
  tell("offset from round trips of 0.6 to 1.2 ms", with_ms, "ms");
  EXPECT_LT(with_ms.back(), 0.3);
  Sensor sensor(0);
  DeviceClock without(options);
  EXPECT_NEAR(sweep_after(without, sensor, 1000).mean_ms, -3.0, 0.1);
}

TEST(DeviceClock, TheStampsOriginMattersAfterRoundTripsOnly) {
  const auto first_beam_ms = [](StampOrigin origin, bool has_round_trips) {
    Sensor sensor(3);
    DeviceClockOptions options;
    options.stamp_origin = origin;
    DeviceClock clock(options);
    for (int trip = 0; trip < 20 && has_round_trips; ++trip) sensor.round_trip(clock, 50.0);
    return sweep_after(clock, sensor, 400).mean_ms;
  };
  EXPECT_NEAR(
      first_beam_ms(StampOrigin::kRearCentre, true) - first_beam_ms(StampOrigin::kFirstBeam, true),
      kPeriodMs / 8, 0.01);
  EXPECT_NEAR(first_beam_ms(StampOrigin::kRearCentre, false),
              first_beam_ms(StampOrigin::kFirstBeam, false), 0.01);
}

TEST(DeviceClock, RoundTripsOfAnotherClockAreNotBelieved) {
  Sensor sensor(1);
  DeviceClock clock({});
  const SimulatedLine line = sensor.line(0);
  clock.add_round_trip((line.stamp_ms + 100'000) & 0xFFFFFF, line.arrival_ns - 1'000'000,
                       line.arrival_ns);
  EXPECT_NEAR(sweep_after(clock, sensor, 400).mean_ms, 0.0, 0.1);
  EXPECT_FALSE(clock.quality().offset_from_round_trips);
}

TEST(DeviceClock, TheCounterWrapsUnnoticed) {
  Sensor sensor(5, 0x1000000 - 420 * kPeriodMs);
  DeviceClock clock({});
  const Sweep sweep = sweep_after(clock, sensor, 400);
  EXPECT_LT(sensor.line(440).stamp_ms, 1000U);
  EXPECT_LT(sweep.jitter_ms, 0.02);
  EXPECT_EQ(clock.restarts(), 0U);
}

TEST(DeviceClock, LostLinesAreCountedAndHarmNothing) {
  Sensor sensor(6);
  DeviceClock clock({});
  std::mt19937 random(6);
  std::int64_t lost = 0;
  std::int64_t lost_truly = 0;
  for (int number = 0; number < 1000; ++number) {
    const SimulatedLine line = sensor.line(number);
    const bool is_lost =
        number > 0 && number < 999 && (random() % 3 == 0 || (number > 500 && number < 600));
    lost_truly += is_lost ? 1 : 0;
    if (is_lost) continue;
    const LineTime time = clock.add(line.stamp_ms, line.arrival_ns);
    lost += time.lines_lost;
    if (number > 400) {
      EXPECT_NEAR(static_cast<double>(time.beam0_time_ns - line.beam0_ns) * 1e-6, 0.0, 0.15);
    }
  }
  EXPECT_EQ(lost, lost_truly);
  EXPECT_EQ(clock.restarts(), 0U);
}

// What is fed after 400 good lines, with stamps and arrivals shifted.
struct Aftermath {
  std::uint64_t restarts = 0;
  double mean_ms = 0.0;
};

Aftermath after_a_shift(std::int64_t stamp_shift_ms, std::int64_t arrival_shift_ns) {
  Sensor sensor(8, 9'000'000.0);
  DeviceClock clock({});
  stream(clock, sensor, 0, 400);
  std::vector<double> errors_ms;
  for (int number = 400; number < 700; ++number) {
    const SimulatedLine line = sensor.line(number);
    const auto stamp_ms = static_cast<std::uint32_t>(line.stamp_ms + stamp_shift_ms) & 0xFFFFFF;
    const LineTime time = clock.add(stamp_ms, line.arrival_ns + arrival_shift_ns);
    errors_ms.push_back(static_cast<double>(time.beam0_time_ns - line.beam0_ns - arrival_shift_ns) *
                        1e-6);
  }
  errors_ms.erase(errors_ms.begin(), errors_ms.end() - 40);
  return {clock.restarts(), statistics(errors_ms).mean_ms};
}

TEST(DeviceClock, AJumpOfEitherClockStartsAnewAndIsTold) {
  for (const auto& [stamp_shift_ms, arrival_shift_ns] :
       std::vector<std::pair<std::int64_t, std::int64_t>>{{-8'000'000, 0},  // rebooted
                                                          {12, 0},
                                                          {500, 0},
                                                          {-500, 0},
                                                          {3'600'000, 0},
                                                          {0, -20'000'000},
                                                          {0, -3'600'000'000'000},
                                                          {0, 3'600'000'000'000}}) {
    const Aftermath aftermath = after_a_shift(stamp_shift_ms, arrival_shift_ns);
    EXPECT_EQ(aftermath.restarts, 1U) << stamp_shift_ms << " ms, " << arrival_shift_ns << " ns";
    EXPECT_NEAR(aftermath.mean_ms, 0.0, 0.1);
  }
  EXPECT_EQ(after_a_shift(0, 0).restarts, 0U);
}

TEST(DeviceClock, AStalledComputerMovesNothing) {
  Sensor sensor(9);
  DeviceClock clock({});
  stream(clock, sensor, 0, 400);
  const std::int64_t resumed_ns = sensor.line(460).arrival_ns;
  for (int number = 400; number < 500; ++number) {
    const SimulatedLine line = sensor.line(number);
    const LineTime time = clock.add(line.stamp_ms, std::max(line.arrival_ns, resumed_ns));
    EXPECT_NEAR(static_cast<double>(time.beam0_time_ns - line.beam0_ns) * 1e-6, 0.0, 0.1) << number;
  }
  EXPECT_EQ(clock.restarts(), 0U);
}

// A network that becomes 3 ms slower looks like a clock that was set, and is neither followed at
// once nor ever by a step.
TEST(DeviceClock, OnceSteadyCorrectionsAreSlewed) {
  Sensor sensor(10);
  DeviceClock clock({});
  std::int64_t before_ns = 0;
  for (int number = 0; number < 3000; ++number) {
    const SimulatedLine line = sensor.line(number);
    const bool is_steady = clock.quality().steady;
    const std::int64_t slower_ns = number < 1000 ? 0 : 3'000'000;
    const std::int64_t time_ns =
        clock.add(line.stamp_ms, line.arrival_ns + slower_ns).beam0_time_ns;
    const double step_ns = static_cast<double>(time_ns - before_ns);
    if (is_steady) {
      // 50 ppm, and the eighth of a turn before beam 0, whose length is estimated anew.
      EXPECT_NEAR(step_ns / clock.scan_period_ns(), 1.0, 100e-6) << number;
    }
    before_ns = time_ns;
  }
  EXPECT_EQ(clock.restarts(), 0U);
}

TEST(DeviceClock, AnyStampsAndArrivalsAreSurvived) {
  std::mt19937_64 random(11);
  DeviceClock clock({});
  for (int number = 0; number < 3000; ++number) {
    const LineTime time = clock.add(static_cast<std::uint32_t>(random()) & 0xFFFFFF,
                                    static_cast<std::int64_t>(random() >> 3));
    EXPECT_GE(time.lines_lost, 0);
  }
  EXPECT_GT(clock.restarts(), 1000U);
  Sensor sensor(12);
  EXPECT_LT(sweep_after(clock, sensor, 400).jitter_ms, 0.02);
}

}  // namespace
}  // namespace swivel
