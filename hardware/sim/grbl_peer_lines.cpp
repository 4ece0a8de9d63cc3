// What GRBL does with a line, and its status report.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "hardware/sim/grbl_peer.hpp"

namespace swivel::sim {
namespace {

constexpr double kMmPerInch = 25.4;

std::string upper_case_without_blanks(const std::string& line) {
  std::string packed;
  for (const char c : line) {
    if (c != ' ') packed += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return packed;
}

}  // namespace

GrblError GrblPeer::execute_system_line(const std::string& raw, std::int64_t now_ns) {
  const std::string line = upper_case_without_blanks(raw);
  if (line.rfind("$J=", 0) == 0) {
    const bool ready = state_ == State::kIdle || state_ == State::kJog;
    return ready ? execute_jog(std::string_view(line).substr(3), now_ns) : kNotIdle;
  }
  if (line == "$X") return unlock();
  if (state_ != State::kIdle && state_ != State::kAlarm) return kNotIdle;
  if (line == "$") {
    output_ += "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]\r\n";
  } else if (line == "$$") {
    output_ += settings_.listing();
  } else if (line == "$I") {
    output_ += "[VER:1.1h.20190830:]\r\n[OPT:V,15,128]\r\n";
  } else if (line == "$G") {
    output_ += absolute_ ? "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\n"
                         : "[GC:G0 G54 G17 G21 G91 G94 M5 M9 T0 F0 S0]\r\n";
  } else if (line == "$H") {
    return begin_homing(now_ns);
  } else if (line == "$SLP") {
    return sleep();
  } else {
    return change_setting(std::string_view(line).substr(1));
  }
  return kNoError;
}

GrblError GrblPeer::unlock() {
  if (state_ != State::kAlarm) return kNoError;
  state_ = State::kIdle;
  output_ += "[MSG:Caution: Unlocked]\r\n";
  return kNoError;
}

GrblError GrblPeer::sleep() {
  answer(kNoError);
  output_ += "[MSG:Sleeping]\r\n";
  state_ = State::kSleep;
  return kNoError;
}

GrblError GrblPeer::begin_homing(std::int64_t now_ns) {
  if (!settings_.homing()) return kHomingDisabled;
  homing_ends_ns_ = axis_.begin_homing(settings_, now_ns);
  homing_phase_ = 0;
  state_ = State::kHome;
  return kNoError;
}

GrblError GrblPeer::change_setting(std::string_view assignment) {
  if (assignment.empty() || assignment.front() < '0' || assignment.front() > '9') {
    return kUnknownCommand;
  }
  const auto number = take_grbl_number(assignment);
  if (!number || assignment.empty() || assignment.front() != '=') return kUnknownCommand;
  assignment.remove_prefix(1);
  const auto value = take_grbl_number(assignment);
  if (!value || !assignment.empty()) return kBadNumber;
  if (*number > 255.0 || !settings_.knows(static_cast<int>(*number))) return kUnknownCommand;
  return settings_.set(static_cast<int>(*number), *value) ? kNoError : kBadNumber;
}

double GrblPeer::target_deg(const GrblWords& words, bool absolute) const {
  const double planned = axis_.planned_end_deg(settings_);
  if (!words.x) return planned;
  const double value = *words.x * (words.inches ? kMmPerInch : 1.0);
  return absolute || words.machine_coordinates ? value : planned + value;
}

bool GrblPeer::beyond_travel(double target) const {
  constexpr double kRoundingDeg = 1e-6;
  constexpr double kFarthestDeg = 1e6;  // beyond it GRBL's floats lose whole steps
  if (std::abs(target) > kFarthestDeg) return true;
  return settings_.soft_limits() &&
         (target < -settings_.travel_deg() - kRoundingDeg || target > kRoundingDeg);
}

GrblError GrblPeer::execute_jog(std::string_view text, std::int64_t now_ns) {
  const GrblWords words = parse_grbl_words(text);
  if (words.error != kNoError) return words.error;
  if (words.motion) return kInvalidJog;
  if (!words.any_axis()) return kNoAxis;
  if (words.feed_per_min.value_or(0.0) <= 0.0) return kNoFeed;
  const double target = target_deg(words, words.absolute.value_or(absolute_));
  if (beyond_travel(target)) return kBeyondTravel;
  if (target == axis_.planned_end_deg(settings_)) return kNoError;
  const double feed = *words.feed_per_min * (words.inches ? kMmPerInch : 1.0);
  axis_.move_to(target, feed / 60.0, settings_, now_ns);
  state_ = State::kJog;
  return kNoError;
}

GrblError GrblPeer::execute_motion(std::string_view text, std::int64_t now_ns) {
  const GrblWords words = parse_grbl_words(text);
  if (words.error != kNoError) return words.error;
  const int motion_word = words.motion.value_or(motion_word_);
  const double feed = words.feed_per_min.value_or(feed_per_min_);
  if (words.any_axis() && motion_word == 1 && feed <= 0.0) return kNoFeed;
  absolute_ = words.absolute.value_or(absolute_);
  motion_word_ = motion_word;
  feed_per_min_ = feed;
  if (!words.any_axis()) return words.motion ? kNoAxis : kNoError;
  const double target = target_deg(words, absolute_);
  if (beyond_travel(target)) {
    axis_.halt(now_ns);
    alarm(2);
    quiet_until_ns_ = now_ns + kAlarmSilence_ns;
    return kNoError;
  }
  if (target == axis_.planned_end_deg(settings_)) return kNoError;
  const double speed = motion_word == 0 ? settings_.fastest_deg_s() : feed / 60.0;
  axis_.move_to(target, speed, settings_, now_ns);
  if (state_ == State::kIdle) state_ = State::kRun;
  return kNoError;
}

std::string GrblPeer::state_name(std::int64_t now_ns) const {
  switch (state_) {
    case State::kIdle:
      return "Idle";
    case State::kRun:
      return "Run";
    case State::kJog:
      return "Jog";
    case State::kHold:
      return axis_.moving(now_ns) ? "Hold:1" : "Hold:0";
    case State::kHome:
      return "Home";
    case State::kAlarm:
      return "Alarm";
    case State::kSleep:
      break;
  }
  return "Sleep";
}

// GRBL answers at once; an encoder is read first, and its reading sent.
void GrblPeer::take_status_request(std::int64_t now_ns) {
  if (status_requested_) return;
  status_requested_ = true;
  report_due_ns_ = report_of_ns_ = now_ns;
  const EncoderOptions& encoder = options_.encoder;
  if (!encoder.present) return;
  const double latency_s = 1e-3 * latency_.uniform(encoder.latency_min_ms, encoder.latency_max_ms);
  report_due_ns_ += ns_from_s(latency_s);
  report_of_ns_ += ns_from_s(latency_s * latency_.uniform());
}

// The work offset comes with the first report and every 10th (30th in motion); the overrides
// with the report after it.
std::string GrblPeer::status_report(std::int64_t now_ns) {
  status_requested_ = false;
  char text[96];
  std::snprintf(text, sizeof text, "|MPos:%.3f,0.000,0.000|FS:%.0f,0",
                axis_.position_deg(settings_, now_ns),
                axis_.believed_speed_deg_s(settings_, now_ns) * 60.0);
  std::string report = "<" + state_name(now_ns) + text;
  if (axis_.at_switch(settings_, now_ns)) report += "|Pn:X";
  const bool offset_due = reports_to_offset_ == 0;
  if (offset_due) {
    report += "|WCO:0.000,0.000,0.000";
    reports_to_offset_ = in_motion_state() ? 30 : 10;
    reports_to_override_ = 1;
  } else if (reports_to_override_ == 0) {
    report += "|Ov:100,100,100";
    reports_to_override_ = reports_to_offset_ + 1;
  }
  --reports_to_offset_;
  reports_to_override_ = std::max(0, reports_to_override_ - 1);
  return report + ">\r\n";
}

}  // namespace swivel::sim
