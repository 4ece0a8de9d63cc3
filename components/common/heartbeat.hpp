// When a thread last showed that it works: noted by itself, asked for by another.
#pragma once

#include <atomic>
#include <chrono>

namespace swivel {

class Heartbeat {
 public:
  void beat() { time_ = now(); }
  bool was_within(std::chrono::milliseconds silence) const {
    return Clock::duration(now() - time_) < silence;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static Clock::rep now() { return Clock::now().time_since_epoch().count(); }

  std::atomic<Clock::rep> time_{now()};
};

}  // namespace swivel
