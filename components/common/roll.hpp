// Who is there: what each participant last said of its health. Thread-safe.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/participant.hpp"

namespace swivel {

struct RollEntry {
  msg::Health first;
  msg::Health last;
  std::chrono::steady_clock::time_point first_seen;
  std::chrono::steady_clock::time_point last_seen;

  // Of a counter, a second; none until it was seen twice.
  std::optional<double> rate(const std::string& counter) const;
};

class Roll {
 public:
  // Subscribes: before participant.start().
  explicit Roll(Participant& participant);

  std::map<std::string, RollEntry> entries() const;

  // Until all of them are there and ready. Else says in words who is not, and what it does.
  std::string await(const std::vector<std::string>& names, std::chrono::seconds patience) const;

 private:
  std::string missing(const std::vector<std::string>& names) const;

  mutable std::mutex mutex_;
  std::map<std::string, RollEntry> entries_;
};

const char* health_word(msg::HealthState state);
std::optional<std::uint64_t> counter_of(const msg::Health& health, const std::string& name);

}  // namespace swivel
