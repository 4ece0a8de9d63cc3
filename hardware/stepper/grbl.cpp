#include "hardware/stepper/grbl.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace swivel {
namespace {

struct NamedState {
  GrblState state;
  const char* name;
};
constexpr std::array<NamedState, 9> kStates{{{GrblState::kIdle, "Idle"},
                                             {GrblState::kRun, "Run"},
                                             {GrblState::kHold, "Hold"},
                                             {GrblState::kJog, "Jog"},
                                             {GrblState::kAlarm, "Alarm"},
                                             {GrblState::kDoor, "Door"},
                                             {GrblState::kCheck, "Check"},
                                             {GrblState::kHome, "Home"},
                                             {GrblState::kSleep, "Sleep"}}};

// charconv, unlike stdio, knows no locale.
std::string fixed(double value, int decimals) {
  std::array<char, 340> text{};
  const auto end =
      std::to_chars(text.begin(), text.end(), value, std::chars_format::fixed, decimals);
  return std::string(text.begin(), end.ptr);
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (text.substr(0, prefix.size()) != prefix) return false;
  text.remove_prefix(prefix.size());
  return true;
}

// Takes the text up to `separator`, which goes too; all of it when there is none.
std::string_view take_until(std::string_view& text, char separator) {
  const std::string_view head = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(head.size() + 1, text.size()));
  return head;
}

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return number;
}

std::optional<double> parse_finite(std::string_view text) {
  const std::optional<double> number = parse_number<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<int> parse_code(std::string_view text) {
  const std::optional<int> code = parse_number<int>(text);
  return code && *code >= 0 ? code : std::nullopt;
}

bool parse_state(std::string_view text, GrblStatus& status) {
  const std::string_view name = take_until(text, ':');
  if (!text.empty() && !(status.substate = parse_code(text))) return false;
  for (const NamedState& known : kStates) {
    if (name == known.name) return status.state = known.state, true;
  }
  return false;
}

bool parse_x(std::string_view values, std::optional<double>& x) {
  x = parse_finite(take_until(values, ','));
  return x.has_value();
}

bool parse_feed(std::string_view values, GrblStatus& status) {
  const std::optional<double> feed_deg_min = parse_finite(take_until(values, ','));
  if (feed_deg_min) status.speed_deg_s = *feed_deg_min / 60.0;
  return feed_deg_min.has_value();
}

bool parse_overrides(std::string_view values, GrblStatus& status) {
  std::array<int, 3> percents{};
  for (int& percent : percents) {
    const std::optional<int> parsed = parse_code(take_until(values, ','));
    if (!parsed) return false;
    percent = *parsed;
  }
  status.overrides_percent = percents;
  return true;
}

bool parse_field(std::string_view field, GrblStatus& status) {
  if (take_prefix(field, "MPos:")) return parse_x(field, status.machine_deg);
  if (take_prefix(field, "WPos:")) return parse_x(field, status.work_deg);
  if (take_prefix(field, "WCO:")) return parse_x(field, status.work_offset_deg);
  if (take_prefix(field, "FS:") || take_prefix(field, "F:")) return parse_feed(field, status);
  if (take_prefix(field, "Ov:")) return parse_overrides(field, status);
  if (take_prefix(field, "Pn:")) status.active_pins = field;
  return true;  // other fields are allowed
}

std::optional<GrblMessage> parse_status(std::string_view inside) {
  GrblStatus status;
  if (!parse_state(take_until(inside, '|'), status)) return std::nullopt;
  while (!inside.empty()) {
    if (!parse_field(take_until(inside, '|'), status)) return std::nullopt;
  }
  return status;
}

// GRBL's settings end at $132. Who listens keeps them by their number: more would be without end.
std::optional<GrblMessage> parse_setting(std::string_view text) {
  constexpr int kHighestSetting = 255;
  const std::optional<int> number = parse_code(take_until(text, '='));
  const std::optional<double> value = parse_finite(take_until(text, ' '));
  if (!number || *number > kHighestSetting || !value) return std::nullopt;
  return GrblSetting{*number, *value};
}

std::optional<GrblMessage> parse_feedback(std::string_view inside) {
  const std::string_view tag = take_until(inside, ':');
  return GrblFeedback{std::string(tag), std::string(inside)};
}

template <class Coded>
std::optional<GrblMessage> parse_coded(std::string_view text) {
  const std::optional<int> code = parse_code(text);
  return code ? std::optional<GrblMessage>(Coded{*code}) : std::nullopt;
}

}  // namespace

std::string grbl_jog_line(double machine_deg, double speed_deg_s) {
  return "$J=G53 G21 X" + fixed(machine_deg, 3) + " F" + fixed(speed_deg_s * 60.0, 3) + "\n";
}

const char* grbl_state_name(GrblState state) {
  for (const NamedState& known : kStates) {
    if (known.state == state) return known.name;
  }
  return "unknown";
}

std::optional<GrblMessage> parse_grbl_line(std::string_view line) {
  if (line == "ok") return GrblOk{};
  if (take_prefix(line, "error:")) return parse_coded<GrblError>(line);
  if (take_prefix(line, "ALARM:")) return parse_coded<GrblAlarm>(line);
  if (take_prefix(line, "Grbl ")) return GrblBanner{std::string(take_until(line, ' '))};
  if (take_prefix(line, "$")) return parse_setting(line);
  if (line.size() < 2) return std::nullopt;
  const std::string_view inside = line.substr(1, line.size() - 2);
  if (line.front() == '<' && line.back() == '>') return parse_status(inside);
  if (line.front() == '[' && line.back() == ']') return parse_feedback(inside);
  return std::nullopt;
}

std::vector<GrblMessage> GrblParser::push(std::string_view bytes) {
  std::vector<GrblMessage> messages;
  bytes_received_ += bytes.size();
  for (const char byte : bytes) {
    if (byte == '\n' || byte == '\r') {
      end_line(messages);
    } else if (line_.size() < kLongestLine) {
      line_.push_back(byte);
    } else {
      too_long_ = true;
    }
  }
  return messages;
}

void GrblParser::end_line(std::vector<GrblMessage>& messages) {
  if (line_.empty()) return;  // between CR and LF, and before the banner
  std::optional<GrblMessage> message = too_long_ ? std::nullopt : parse_grbl_line(line_);
  line_.clear();
  too_long_ = false;
  if (message) {
    messages.push_back(std::move(*message));
  } else {
    ++garbage_lines_;
  }
}

}  // namespace swivel
