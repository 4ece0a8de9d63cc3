// Ends a blocked wait from another thread, or from a signal handler.
#pragma once

namespace swivel {

// Once notified it stays so: every wait that is given it ends at once, until clear().
class WakeUp {
 public:
  WakeUp();  // throws std::system_error when the process is out of descriptors
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void notify() const;  // safe in a signal handler
  void clear() const;

  int descriptor() const { return reading_end_; }  // readable while notified

 private:
  int reading_end_ = -1;
  int writing_end_ = -1;
};

}  // namespace swivel
