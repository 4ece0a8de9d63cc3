// What ends the sequencer's waits from another thread: a stop for good, or the cancel of the
// request under way.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "hardware/io/wake_up.hpp"

namespace swivel {

class Interruption {
 public:
  void stop();
  void cancel();
  void clear_cancel();
  bool stopping() const;
  bool interrupted() const;  // stopped or cancelled

  // Waits until then; false as soon as it is interrupted.
  bool pause_until(std::int64_t time_ns) const;

  const WakeUp& stop_signal() const { return stop_signal_; }  // for waits on a descriptor

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  WakeUp stop_signal_;
  bool stopping_ = false;
  bool cancelled_ = false;
};

}  // namespace swivel
