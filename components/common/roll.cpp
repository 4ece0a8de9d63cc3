#include "components/common/roll.hpp"

#include <algorithm>
#include <thread>

namespace swivel {

using std::chrono::steady_clock;

namespace {

// Of one rig. Names are a writer's own choice, and a hostile one's without end.
constexpr std::size_t kMostParticipants = 256;

}  // namespace

Roll::Roll(Participant& participant) {
  participant.subscribe<msg::Health>(kHealthTopic, [this](const msg::Health& health) {
    const std::lock_guard lock(mutex_);
    const auto now = steady_clock::now();
    const bool known = entries_.count(health.participant().to_string()) != 0;
    if (!known && entries_.size() == kMostParticipants) return;
    RollEntry& entry = entries_[health.participant().to_string()];
    const bool other_process = entry.last.process_id() != health.process_id();
    if (other_process) entry = {health, health, now, now};
    entry.last = health;
    entry.last_seen = now;
  });
}

std::map<std::string, RollEntry> Roll::entries() const {
  const std::lock_guard lock(mutex_);
  return entries_;
}

std::string Roll::missing(const std::vector<std::string>& names) const {
  const auto entries = this->entries();
  std::string words;
  for (const std::string& name : names) {
    const auto found = entries.find(name);
    const bool gone = found == entries.end() || found->second.last.state() == msg::HEALTH_STOPPED;
    if (!gone && found->second.last.state() == msg::HEALTH_OK) continue;
    words += (words.empty() ? "" : "; ") + name +
             (gone ? " is not there" : ": " + found->second.last.doing());
  }
  return words;
}

std::string Roll::await(const std::vector<std::string>& names,
                        std::chrono::seconds patience) const {
  const auto deadline = steady_clock::now() + patience;
  std::string words = missing(names);
  while (!words.empty() && steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    words = missing(names);
  }
  return words;
}

std::optional<double> RollEntry::rate(const std::string& counter) const {
  const auto before = counter_of(first, counter);
  const auto after = counter_of(last, counter);
  const double passed_s =
      (static_cast<double>(last.time_ns()) - static_cast<double>(first.time_ns())) * 1e-9;
  if (!before || !after || *after < *before || passed_s <= 0.0) return std::nullopt;
  return static_cast<double>(*after - *before) / passed_s;
}

std::optional<std::uint64_t> counter_of(const msg::Health& health, const std::string& name) {
  const auto& counters = health.counters();
  const auto found =
      std::find_if(counters.begin(), counters.end(),
                   [&](const msg::Counter& counter) { return counter.name() == name; });
  return found == counters.end() ? std::nullopt : std::optional(found->value());
}

const char* health_word(msg::HealthState state) {
  switch (state) {
    case msg::HEALTH_OK:
      return "ok";
    case msg::HEALTH_WAITING:
      return "waiting";
    case msg::HEALTH_DEGRADED:
      return "degraded";
    case msg::HEALTH_FAULT:
      return "fault";
    case msg::HEALTH_STOPPED:
      return "stopped";
  }
  return "unknown";
}

}  // namespace swivel
