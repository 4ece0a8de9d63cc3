#include "components/stepper_sequencer/interruption.hpp"

#include <algorithm>
#include <chrono>

#include "hardware/io/clock.hpp"

namespace swivel {

void Interruption::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  stop_signal_.notify();
  changed_.notify_all();
}

void Interruption::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
  changed_.notify_all();
}

void Interruption::clear_cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = false;
}

bool Interruption::stopping() const {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

bool Interruption::interrupted() const {
  const std::lock_guard lock(mutex_);
  return stopping_ || cancelled_;
}

bool Interruption::pause_until(std::int64_t time_ns) const {
  const std::chrono::nanoseconds left(std::max<std::int64_t>(0, time_ns - now_ns()));
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, left, [this] { return stopping_ || cancelled_; });
}

}  // namespace swivel
