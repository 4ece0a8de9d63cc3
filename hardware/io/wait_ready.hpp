// poll(2) on one descriptor and a wake-up, until a deadline. Private to hardware/io.
#pragma once

#include <chrono>

#include "hardware/io/wake_up.hpp"

namespace swivel {

using Deadline = std::chrono::steady_clock::time_point;

inline Deadline deadline_after(std::chrono::milliseconds timeout) {
  return std::chrono::steady_clock::now() + timeout;
}

enum class Wait { kReady, kTimeout, kInterrupted, kError };  // kError: see errno

// `events` as for poll: POLLIN or POLLOUT. A hang-up counts as ready: the next call tells.
Wait wait_ready(int descriptor, short events, Deadline deadline, const WakeUp* wake_up);

}  // namespace swivel
