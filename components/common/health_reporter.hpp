// Publishes what a participant does, its counters and its last error, once a second and when
// something changes; tells systemd, too, where that started the program (Type=notify, WatchdogSec).
// Thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "components/dds/participant.hpp"

namespace swivel {

class HealthReporter {
 public:
  // Subscribes itself to the participant's problems and ticks: before participant.start().
  explicit HealthReporter(Participant& participant);
  ~HealthReporter();  // says HEALTH_STOPPED

  void set_state(msg::HealthState state, const std::string& doing);
  // Logs it, too.
  void error(const std::string& what);
  void set_counter(const std::string& name, std::uint64_t value);
  void set_fact(const std::string& name, const std::string& value);

  // Asked once a second on the participant's thread, which by itself shows only that this thread
  // works: false leaves the program to systemd's watchdog. Before participant.start().
  void watch_over(std::function<bool()> others_work);

 private:
  void publish();
  void feed_watchdog() const;

  Participant& participant_;
  Writer<msg::Health> writer_;
  std::mutex mutex_;
  msg::Health health_;
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, std::string> facts_;
  std::function<bool()> others_work_ = [] { return true; };
};

}  // namespace swivel
