#include "hardware/sim/grbl_peer.hpp"

#include <algorithm>
#include <utility>

namespace swivel::sim {
namespace {

constexpr std::size_t kReceiveBuffer = 127;  // 128 bytes, one of which marks its end
constexpr std::size_t kLongestLine = 79;
constexpr int kPlannerBlocks = 15;
constexpr std::int64_t kBusyTick_ns = 2 * kMillisecond_ns;
constexpr std::uint64_t kLatencyStream = 0x1A7E;
constexpr char kReset = 0x18;
constexpr char kJogCancel = static_cast<char>(0x85);
constexpr const char* kBanner = "\r\nGrbl 1.1h ['$' for help]\r\n";
constexpr const char* kUnlockHint = "[MSG:'$H'|'$X' to unlock]\r\n";

}  // namespace

GrblPeer::GrblPeer(const MotorOptions& options, std::uint64_t seed, std::int64_t now_ns)
    : options_(options),
      settings_(options.travel_deg),
      axis_(options, seed, now_ns),
      latency_(seed, kLatencyStream) {
  power_up(now_ns);
}

void GrblPeer::power_up(std::int64_t now_ns) {
  axis_.zero_position(now_ns);
  output_.clear();
  state_ = settings_.homing() ? State::kAlarm : State::kIdle;
  restart(std::llround(options_.boot_s * 1e9), now_ns);
}

// Silent for a while, then the banner: what power-up and every reset end with.
void GrblPeer::restart(std::int64_t quiet_ns, std::int64_t now_ns) {
  received_.clear();
  dead_ = reset_requested_ = status_requested_ = false;
  absolute_ = true;
  motion_word_ = 0;
  feed_per_min_ = 0.0;
  reports_to_offset_ = reports_to_override_ = 0;
  quiet_until_ns_ = now_ns + quiet_ns;
  after_quiet_ = kBanner;
  if (state_ == State::kAlarm) after_quiet_ += kUnlockHint;
}

void GrblPeer::reset(std::int64_t now_ns) {
  const bool lost = in_motion_state() && axis_.moving(now_ns);
  axis_.halt(now_ns);
  if (lost) output_ += state_ == State::kHome ? "ALARM:6\r\n" : "ALARM:3\r\n";
  const bool locked = lost || dead_ || state_ == State::kAlarm || state_ == State::kSleep;
  state_ = locked ? State::kAlarm : State::kIdle;
  restart(lost ? kAlarmSilence_ns : 20 * kMillisecond_ns, now_ns);
}

void GrblPeer::alarm(int number) {
  output_ += "ALARM:" + std::to_string(number) + "\r\n";
  state_ = State::kAlarm;
  dead_ = true;
  after_quiet_ = "[MSG:Reset to continue]\r\n";
}

void GrblPeer::raise_alarm(int number, std::int64_t now_ns) {
  advance(now_ns);
  axis_.halt(now_ns);
  alarm(number);
  quiet_until_ns_ = now_ns + kAlarmSilence_ns;
  if (number == 1 || number == 2) return;
  dead_ = false;
  after_quiet_.clear();
  const bool a_probes = number == 4 || number == 5;
  if (!a_probes) restart(kAlarmSilence_ns, now_ns);
}

std::string GrblPeer::take_output() {
  return std::exchange(output_, {});
}

bool GrblPeer::busy(std::int64_t now_ns) const {
  return !after_quiet_.empty() || reset_requested_ || status_requested_ || in_motion_state() ||
         axis_.moving(now_ns) || received_.find('\n') != std::string::npos;
}

std::int64_t GrblPeer::next_event_ns(std::int64_t now_ns) const {
  return busy(now_ns) ? now_ns + kBusyTick_ns : kNever_ns;
}

bool GrblPeer::in_motion_state() const {
  return state_ == State::kRun || state_ == State::kJog || state_ == State::kHold ||
         state_ == State::kHome;
}

void GrblPeer::receive(std::string_view bytes, std::int64_t now_ns) {
  advance(now_ns);
  for (const char byte : bytes) {
    take_byte(byte, now_ns);
    advance(now_ns);
  }
}

void GrblPeer::take_byte(char byte, std::int64_t now_ns) {
  const bool starting = now_ns < quiet_until_ns_;  // what comes meanwhile is not read
  const bool deaf = dead_ || state_ == State::kHome;
  const bool override_byte = (static_cast<unsigned char>(byte) & 0x80U) != 0U;
  if (byte == kReset) {
    reset_requested_ = true;
  } else if (starting) {
    return;
  } else if (byte == '?') {
    take_status_request(now_ns);
  } else if (byte == '!' || byte == '~' || override_byte) {
    if (deaf) return;
    if (byte == '!') hold(now_ns);
    if (byte == '~') resume(now_ns);
    if (byte == kJogCancel) cancel_jog(now_ns);
  } else if (received_.size() >= kReceiveBuffer) {
    ++bytes_lost_;
  } else if (byte == '\r') {
    received_ += '\n';
  } else {
    received_ += byte;
  }
}

void GrblPeer::hold(std::int64_t now_ns) {
  if (state_ == State::kJog) return cancel_jog(now_ns);
  if (state_ != State::kRun && state_ != State::kIdle) return;
  if (state_ == State::kRun) axis_.brake(now_ns);
  state_ = State::kHold;
}

void GrblPeer::resume(std::int64_t now_ns) {
  if (state_ != State::kHold || axis_.moving(now_ns)) return;
  axis_.resume(now_ns);
  state_ = axis_.moving(now_ns) ? State::kRun : State::kIdle;
}

void GrblPeer::cancel_jog(std::int64_t now_ns) {
  if (state_ != State::kJog) return;
  axis_.brake(now_ns);
  axis_.forget_moves();
}

void GrblPeer::advance(std::int64_t now_ns) {
  if (now_ns < quiet_until_ns_) return;
  output_ += std::exchange(after_quiet_, {});
  if (reset_requested_) return reset(now_ns);
  if (dead_) return;
  if (state_ == State::kHome) advance_homing(now_ns);
  if (state_ == State::kHome) return;
  advance_motion(now_ns);
  if (status_requested_ && !dead_ && now_ns >= report_due_ns_) {
    output_ += status_report(report_of_ns_);
  }
  if (!dead_) take_lines(now_ns);
}

// A status request is answered between the phases only, as by the firmware.
void GrblPeer::advance_homing(std::int64_t now_ns) {
  while (homing_phase_ < homing_ends_ns_.size() && now_ns >= homing_ends_ns_[homing_phase_]) {
    ++homing_phase_;
    if (axis_.home_switch() != HomeSwitch::kWorks) {
      // One that never closes was not found; one that never opens cannot be left again.
      output_ += axis_.home_switch() == HomeSwitch::kOpen ? "ALARM:9\r\n" : "ALARM:8\r\n";
      axis_.halt(now_ns);
      state_ = State::kAlarm;
      return restart(kAlarmSilence_ns, now_ns);
    }
    if (status_requested_) output_ += status_report(now_ns);
  }
  if (homing_phase_ < homing_ends_ns_.size()) return;
  axis_.finish_homing(settings_, now_ns);
  state_ = State::kIdle;
  answer(kNoError);
}

void GrblPeer::advance_motion(std::int64_t now_ns) {
  const bool moving = axis_.moving(now_ns);
  if (moving && settings_.hard_limits() && axis_.at_switch(settings_, now_ns)) {
    axis_.halt(now_ns);
    alarm(1);
    quiet_until_ns_ = now_ns + kAlarmSilence_ns;
  } else if (!moving && (state_ == State::kRun || state_ == State::kJog)) {
    state_ = State::kIdle;
  }
}

void GrblPeer::take_lines(std::int64_t now_ns) {
  while (state_ != State::kHome && state_ != State::kSleep && !dead_ && now_ns >= quiet_until_ns_ &&
         axis_.queued(now_ns) < kPlannerBlocks) {
    const std::size_t end = received_.find('\n');
    if (end == std::string::npos) break;
    const std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    execute_line(line, now_ns);
  }
}

void GrblPeer::answer(GrblError error) {
  output_ += error == kNoError ? "ok\r\n" : "error:" + std::to_string(error) + "\r\n";
}

void GrblPeer::execute_line(const std::string& line, std::int64_t now_ns) {
  if (line.size() > kLongestLine) return answer(kLineTooLong);
  if (line.empty()) return answer(kNoError);
  GrblError error = kNoError;
  if (line.front() == '$') {
    error = execute_system_line(line, now_ns);
  } else if (state_ == State::kAlarm || state_ == State::kJog) {
    error = kLocked;
  } else {
    error = execute_motion(line, now_ns);
  }
  const bool answered = state_ == State::kHome || state_ == State::kSleep || dead_;
  if (!answered) answer(error);
}

}  // namespace swivel::sim
