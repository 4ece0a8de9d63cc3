#include "components/common/health_reporter.hpp"

#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <array>

#include "components/log/log.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

// One line: the next would be another message to systemd.
void tell_systemd(const std::string& doing) {
  sd_notify(0, ("STATUS=" + doing.substr(0, doing.find('\n'))).c_str());
}

}  // namespace

HealthReporter::HealthReporter(Participant& participant)
    : participant_(participant), writer_(participant, kHealthTopic) {
  health_.participant(participant.name());
  health_.process_id(static_cast<std::uint32_t>(getpid()));
  health_.host(host_name());
  health_.started_time_ns(now_ns());
  health_.state(msg::HEALTH_WAITING);
  health_.doing("starting");
  participant.on_problem([this](const std::string& problem) {
    const std::lock_guard lock(mutex_);
    health_.last_error(problem);
    health_.last_error_time_ns(now_ns());
  });
  participant.on_tick(std::chrono::seconds(1), [this] {
    const std::lock_guard lock(mutex_);
    publish();
    feed_watchdog();
  });
}

HealthReporter::~HealthReporter() {
  sd_notify(0, "STOPPING=1");
  set_state(msg::HEALTH_STOPPED, "stopped");
}

void HealthReporter::set_state(msg::HealthState state, const std::string& doing) {
  const std::lock_guard lock(mutex_);
  if (health_.state() == state && health_.doing() == doing) return;
  health_.state(state);
  health_.doing(doing);
  publish();
}

void HealthReporter::error(const std::string& what) {
  log_error("{}", what);
  const std::lock_guard lock(mutex_);
  health_.last_error(what);
  health_.last_error_time_ns(now_ns());
  publish();
}

void HealthReporter::set_counter(const std::string& name, std::uint64_t value) {
  const std::lock_guard lock(mutex_);
  counters_[name] = value;
}

void HealthReporter::set_fact(const std::string& name, const std::string& value) {
  const std::lock_guard lock(mutex_);
  facts_[name] = value;
}

void HealthReporter::watch_over(std::function<bool()> others_work) {
  others_work_ = std::move(others_work);
}

// Ready is who hears and answers others; waiting for a lidar is work, too.
void HealthReporter::feed_watchdog() const {
  if (others_work_()) sd_notify(0, "READY=1\nWATCHDOG=1");
}

void HealthReporter::publish() {
  counters_["samples_lost"] = participant_.samples_lost();
  counters_["samples_refused"] = participant_.samples_refused();
  health_.time_ns(now_ns());
  health_.counters().clear();
  for (const auto& [name, value] : counters_) {
    msg::Counter counter;
    counter.name(name);
    counter.value(value);
    health_.counters().push_back(counter);
  }
  health_.facts().clear();
  for (const auto& [name, value] : facts_) {
    msg::Fact fact;
    fact.name(name);
    fact.value(value);
    health_.facts().push_back(fact);
  }
  writer_.write(health_);
  tell_systemd(health_.doing());
}

}  // namespace swivel
