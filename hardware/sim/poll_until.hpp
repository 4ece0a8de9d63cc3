// How a bench waits: for any of its descriptors, or until something is due.
#pragma once

#include <poll.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <vector>

#include "hardware/io/clock.hpp"
#include "hardware/io/wake_up.hpp"

namespace swivel::sim {

inline bool is_notified(const WakeUp& stop) {
  pollfd wait{stop.descriptor(), POLLIN, 0};
  return ::poll(&wait, 1, 0) > 0;
}

inline void poll_until(std::int64_t until_ns, std::vector<pollfd>& waits) {
  constexpr std::int64_t kLongestWait_ns = 100'000'000;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t time_ns = now_ns();
  const std::int64_t wait_ns =
      until_ns <= time_ns ? 0 : std::min(kLongestWait_ns, until_ns - time_ns);
  const timespec timeout{static_cast<time_t>(wait_ns / kSecond_ns),
                         static_cast<long>(wait_ns % kSecond_ns)};
  ::ppoll(waits.data(), waits.size(), &timeout, nullptr);
}

}  // namespace swivel::sim
