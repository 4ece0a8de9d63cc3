// swivel status: who is alive, what it does, at what rate, and what went wrong last.
#include <fmt/core.h>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>
#include <memory>

#include "components/common/health_json.hpp"
#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/roll.hpp"
#include "components/swivel/live/participants.hpp"
#include "components/swivel/verbs.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

struct StatusOptions {
  double watch_s = 2.5;  // two reports of health, for the rates
  bool json = false;
};

double seconds_since(std::int64_t time_ns) {
  return (static_cast<double>(now_ns()) - static_cast<double>(time_ns)) * 1e-9;
}

std::string rates_in_words(const RollEntry& entry) {
  std::string words;
  for (const msg::Counter& counter : entry.last.counters()) {
    const std::string name = counter.name().to_string();
    const double rate = entry.rate(name).value_or(0.0);
    if (counter.value() == 0) continue;
    words += (words.empty() ? "" : ", ") + name + " " + std::to_string(counter.value());
    if (rate > 0.05) words += fmt::format(" ({:.1f}/s)", rate);
  }
  return words;
}

void print(const std::string& name, const RollEntry& entry) {
  const msg::Health& health = entry.last;
  const std::chrono::duration<double> age = std::chrono::steady_clock::now() - entry.last_seen;
  std::cout << fmt::format("{:<20} {:<9} {}\n", name, health_word(health.state()), health.doing());
  std::cout << fmt::format("{:<20} {:<9} heard {:.1f} s ago, up {:.0f} s, process {} on {}\n", "",
                           "", age.count(), seconds_since(health.started_time_ns()),
                           health.process_id(), health.host());
  if (const std::string rates = rates_in_words(entry); !rates.empty()) {
    std::cout << fmt::format("{:<20} {:<9} {}\n", "", "", rates);
  }
  if (health.last_error_time_ns() != 0) {
    std::cout << fmt::format("{:<20} {:<9} last error, {:.0f} s ago: {}\n", "", "",
                             seconds_since(health.last_error_time_ns()), health.last_error());
  }
}

void print_json(const std::map<std::string, RollEntry>& entries) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, entry] : entries) json[name] = to_json(entry);
  std::cout << json_text(json, 2) << '\n';
}

int status(const CommonOptions& common, const StatusOptions& options, StopSignal& stop) {
  start_log("swivel", "warning");
  const RigFile rig = load_rig_file(common.rig_file);
  Participant participant(common.participant("swivel_status", rig.rig));
  const Roll roll(participant);
  participant.start();
  stop.wait_for(std::chrono::milliseconds(std::llround(options.watch_s * 1e3)));
  const auto entries = roll.entries();
  if (options.json) {
    print_json(entries);
    return entries.empty() ? kExitUnavailable : kExitOk;
  }
  for (const auto& [name, entry] : entries) print(name, entry);
  for (const std::string& name : participants_of("all")) {
    if (entries.count(name) == 0) std::cout << fmt::format("{:<20} not seen\n", name);
  }
  if (!entries.empty()) return kExitOk;
  throw ExitError(
      kExitUnavailable,
      fmt::format("nobody of rig '{}' in DDS domain {} on network '{}'; start them with: "
                  "swivel up",
                  rig.rig, common.domain, common.network));
}

}  // namespace

void add_status(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand("status", "Who is alive, rates, ages, last errors");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<StatusOptions>();
  verb->add_option("--watch-s", options->watch_s, "How long to listen")->capture_default_str();
  verb->add_flag("--json", options->json, "As JSON");
  add_common_options(*verb, *common);
  verb->callback(
      [=, &stop, &chosen] { chosen = [=, &stop] { return status(*common, *options, stop); }; });
}

}  // namespace swivel
