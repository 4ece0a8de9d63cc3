// What the bench does when it is told to by its control port.
//
//   lidar power-cycle S | reset | stall S | stamp MS
//   lidar drop N | half N | bad-sums N | wrong-echo N | status CODE N     the next N scans
//   stepper unplug S | silent S | delay MS | reset | alarm N | lose DEG
//   stepper switch works | open | closed
//   truth shaft      time_ns, angle_deg, and the lowest and highest angle so far
//   truth lines      how many the lidar has sent
#include <cmath>
#include <cstdio>

#include "hardware/sim/bench.hpp"

namespace swivel::sim {
namespace {

constexpr double kLongestS = 3600.0;
constexpr double kMostFrames = 1e6;
constexpr double kLastStamp_ms = 16777215.0;
constexpr const char* kDone = "ok";

}  // namespace

std::string Bench::obey(const std::string& line, std::int64_t now_ns) {
  const Command command = Command::parse(line);
  std::optional<std::string> done;
  if (command.target == "lidar") done = obey_lidar(command, now_ns);
  if (command.target == "stepper") done = obey_stepper(command, now_ns);
  if (command.target == "truth") done = answer(command, now_ns);
  return done.value_or("error: '" + line + "' is no command, or not with these numbers");
}

std::optional<std::string> Bench::obey_lidar(const Command& command, std::int64_t now_ns) {
  const auto duration_s = command.number(0, 0.0, kLongestS);
  if (command.verb == "reset") return server_.reset_connection(), kDone;
  if (command.verb == "power-cycle" && duration_s) {
    timing_.reset_counter(now_ns);
    return server_.lose_power(*duration_s, now_ns), kDone;
  }
  if (command.verb == "stall" && duration_s) return server_.stall(*duration_s, now_ns), kDone;
  if (command.verb == "stamp") {
    const auto counter_ms = command.number(0, 0.0, kLastStamp_ms);
    if (!counter_ms) return std::nullopt;
    return timing_.reset_counter(now_ns, *counter_ms), kDone;
  }
  return spoil_frames(command);
}

std::optional<std::string> Bench::spoil_frames(const Command& command) {
  SpoiledFrames& next = server_.next_frames();
  if (command.verb == "status") {
    const auto frames = command.number(1, 0.0, kMostFrames);
    if (!frames || command.arguments[0].size() != 2) return std::nullopt;
    next.status = command.arguments[0];
    return next.refused = static_cast<int>(*frames), kDone;
  }
  const auto frames = command.number(0, 0.0, kMostFrames);
  if (!frames) return std::nullopt;
  const int count = static_cast<int>(*frames);
  if (command.verb == "drop") return next.dropped = count, kDone;
  if (command.verb == "half") return next.halved = count, kDone;
  if (command.verb == "bad-sums") return next.bad_sums = count, kDone;
  if (command.verb == "wrong-echo") return next.wrong_echoes = count, kDone;
  return std::nullopt;
}

std::optional<std::string> Bench::obey_stepper(const Command& command, std::int64_t now_ns) {
  const auto number = command.number(0, 0.0, kLongestS);
  if (command.verb == "reset") return stepper_.power_up(now_ns), kDone;
  if (command.verb == "switch" && command.arguments.size() == 1) {
    const std::string& state = command.arguments[0];
    if (state == "works") return stepper_.set_switch(HomeSwitch::kWorks), kDone;
    if (state == "open") return stepper_.set_switch(HomeSwitch::kOpen), kDone;
    if (state == "closed") return stepper_.set_switch(HomeSwitch::kClosed), kDone;
  }
  if (!number) return std::nullopt;
  if (command.verb == "unplug") return stepper_port_.unplug(*number, now_ns), kDone;
  if (command.verb == "silent") return stepper_port_.silence(*number, now_ns), kDone;
  if (command.verb == "delay") return stepper_port_.delay_answers(*number * 1e-3), kDone;
  if (command.verb == "lose") return stepper_.lose_steps(*number, now_ns), kDone;
  if (command.verb == "alarm" && *number >= 1.0 && *number <= 10.0) {
    return stepper_.raise_alarm(static_cast<int>(*number), now_ns), kDone;
  }
  return std::nullopt;
}

std::optional<std::string> Bench::answer(const Command& command, std::int64_t now_ns) const {
  if (command.verb == "lines") return "ok " + std::to_string(lines_sent_);
  if (command.verb != "shaft") return std::nullopt;
  char text[128];
  std::snprintf(text, sizeof text, "ok %lld %.4f %.4f %.4f", static_cast<long long>(now_ns),
                stepper_.shaft_angle_deg(now_ns), lowest_deg_, highest_deg_);
  return text;
}

}  // namespace swivel::sim
