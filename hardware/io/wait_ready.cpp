#include "hardware/io/wait_ready.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>

namespace swivel {
namespace {

// Rounded up: a wait of less than a millisecond must not spin.
int milliseconds_until(Deadline deadline) {
  using namespace std::chrono;
  const auto left = ceil<milliseconds>(deadline - steady_clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

}  // namespace

Wait wait_ready(int descriptor, short events, Deadline deadline, const WakeUp* wake_up) {
  const int waker = wake_up == nullptr ? -1 : wake_up->descriptor();  // poll skips -1
  std::array<pollfd, 2> waited{pollfd{descriptor, events, 0}, pollfd{waker, POLLIN, 0}};
  for (;;) {
    const int ready = ::poll(waited.data(), waited.size(), milliseconds_until(deadline));
    if (ready < 0 && errno != EINTR) return Wait::kError;
    if (ready > 0) return waited[1].revents != 0 ? Wait::kInterrupted : Wait::kReady;
    if (std::chrono::steady_clock::now() >= deadline) return Wait::kTimeout;
  }
}

}  // namespace swivel
