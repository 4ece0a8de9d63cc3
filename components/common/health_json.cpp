#include "components/common/health_json.hpp"

#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

double seconds_ago(std::int64_t time_ns) {
  return (static_cast<double>(now_ns()) - static_cast<double>(time_ns)) * 1e-9;
}

}  // namespace

nlohmann::ordered_json to_json(const RollEntry& entry) {
  const msg::Health& health = entry.last;
  const std::chrono::duration<double> age = std::chrono::steady_clock::now() - entry.last_seen;
  nlohmann::ordered_json json{{"state", health_word(health.state())},
                              {"doing", health.doing()},
                              {"age_s", age.count()},
                              {"up_s", seconds_ago(health.started_time_ns())},
                              {"host", health.host()},
                              {"process_id", health.process_id()}};
  for (const msg::Counter& counter : health.counters()) {
    const std::string name = counter.name().to_string();
    json["counters"][name] = counter.value();
    if (const auto rate = entry.rate(name)) json["rates_per_s"][name] = *rate;
  }
  for (const msg::Fact& fact : health.facts())
    json["facts"][fact.name().to_string()] = fact.value();
  json["last_error"] = health.last_error();
  if (health.last_error_time_ns() != 0)
    json["last_error_age_s"] = seconds_ago(health.last_error_time_ns());
  return json;
}

}  // namespace swivel
