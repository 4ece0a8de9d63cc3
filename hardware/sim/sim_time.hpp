// Times of the bench, in nanoseconds.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace swivel::sim {

constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMillisecond_ns = 1'000'000;

inline std::int64_t ns_from_s(double duration_s) {
  return std::llround(duration_s * 1e9);
}

}  // namespace swivel::sim
