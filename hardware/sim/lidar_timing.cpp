#include "hardware/sim/lidar_timing.hpp"

#include <algorithm>
#include <cmath>

#include "hardware/sim/random.hpp"

namespace swivel::sim {
namespace {

constexpr double kNsPerMs = 1e6;
constexpr std::uint64_t kSendStream = 0x5E4D;  // keeps the jitter apart from the ranges' noise

}  // namespace

LidarTiming::LidarTiming(const LidarTimingOptions& options, std::int64_t power_up_ns,
                         int steps_per_turn, int last_beam, std::uint64_t seed)
    : options_(options),
      power_up_ns_(power_up_ns),
      period_ns_(options.scan_period_ms * kNsPerMs),
      steps_per_turn_(steps_per_turn),
      last_beam_(last_beam),
      seed_(seed),
      counter_start_ms_(options.stamp_start_ms),
      counter_since_ns_(power_up_ns) {}

std::uint64_t LidarTiming::next_scan(std::int64_t time_ns) const {
  const double turns = static_cast<double>(time_ns - power_up_ns_) / period_ns_;
  auto scan = static_cast<std::uint64_t>(std::max(0.0, std::floor(turns)));
  while (beam0_time_ns(scan) < time_ns) ++scan;
  return scan;
}

std::int64_t LidarTiming::beam0_time_ns(std::uint64_t scan) const {
  return power_up_ns_ + std::llround(static_cast<double>(scan) * period_ns_);
}

std::int64_t LidarTiming::send_time_ns(std::uint64_t scan) const {
  const double last_beam_ns =
      static_cast<double>(beam0_time_ns(scan) - power_up_ns_) + last_beam_ * beam_period_ns();
  const double tick_ns = std::ceil(last_beam_ns / kNsPerMs) * kNsPerMs;
  Random random(seed_ ^ kSendStream, scan);
  const double delay_ms = options_.send_delay_ms + random.uniform(0.0, options_.send_jitter_ms);
  return power_up_ns_ + std::llround(tick_ns + delay_ms * kNsPerMs);
}

double LidarTiming::counter(double time_ns) const {
  const double elapsed_ms = (time_ns - static_cast<double>(counter_since_ns_)) / kNsPerMs;
  return counter_start_ms_ + elapsed_ms * (1.0 + options_.clock_gain_ppm * 1e-6);
}

std::uint32_t LidarTiming::counter_ms(std::int64_t time_ns) const {
  const auto whole_ms =
      static_cast<std::int64_t>(std::floor(counter(static_cast<double>(time_ns))));
  return static_cast<std::uint32_t>(whole_ms) & 0xFFFFFFU;
}

// The rear centre is passed before the first beam, by the angle between them.
std::uint32_t LidarTiming::stamp_ms(std::uint64_t scan) const {
  const double dead_steps = steps_per_turn_ - last_beam_;
  const double earlier_ns =
      options_.stamp_at_rear_centre ? 0.5 * dead_steps * beam_period_ns() : 0.0;
  return counter_ms(beam0_time_ns(scan) - std::llround(earlier_ns));
}

void LidarTiming::reset_counter(std::int64_t time_ns, double counter_ms) {
  counter_start_ms_ = counter_ms;
  counter_since_ns_ = time_ns;
}

}  // namespace swivel::sim
