#include "components/gateway/metrics.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace swivel {
namespace {

// A name that Prometheus takes, of whatever a participant called its counter.
std::string metric_name(const std::string& counter) {
  std::string name = "swivel_" + counter;
  std::replace_if(
      name.begin(), name.end(),
      [](char c) {
        return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'));
      },
      '_');
  return name;
}

std::string label_value(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '\\' || letter == '"') escaped += '\\';
    escaped += letter == '\n' ? ' ' : letter;
  }
  return escaped;
}

// The samples of one metric stand together, as the format asks.
using Samples = std::map<std::string, std::map<std::string, std::string>>;

std::string in_text_format(const Samples& samples) {
  std::string text;
  for (const auto& [name, by_participant] : samples) {
    text += "# TYPE " + name + " untyped\n";
    for (const auto& [participant, value] : by_participant)
      text += fmt::format("{}{{participant=\"{}\"}} {}\n", name, label_value(participant), value);
  }
  return text;
}

}  // namespace

std::string metrics_text(const std::map<std::string, RollEntry>& participants,
                         std::chrono::steady_clock::time_point now) {
  Samples samples;
  for (const auto& [participant, entry] : participants) {
    const std::chrono::duration<double> age = now - entry.last_seen;
    samples["swivel_health_state"][participant] =
        std::to_string(static_cast<int>(entry.last.state()));
    samples["swivel_health_age_seconds"][participant] = fmt::format("{:.3f}", age.count());
    for (const msg::Counter& counter : entry.last.counters())
      samples[metric_name(counter.name().to_string())][participant] =
          std::to_string(counter.value());
  }
  return "# HELP swivel_health_state 0 ok, 1 waiting, 2 degraded, 3 fault, 4 stopped\n" +
         in_text_format(samples);
}

}  // namespace swivel
