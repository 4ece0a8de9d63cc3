#include "tests/hardware/stepper/grbl_double.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "hardware/io/clock.hpp"

namespace swivel::test {
namespace {

std::int64_t from_now(double seconds) {
  return now_ns() + static_cast<std::int64_t>(seconds * 1e9);
}

void note_real_time(char byte, std::vector<std::string>& lines) {
  if (byte == '?') lines.emplace_back("?");
  if (byte == '\x85') lines.emplace_back("0x85");
  if (byte == '\x18') lines.emplace_back("0x18");
}

std::string fixed(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace

GrblDouble::GrblDouble(GrblDoubleOptions options) : options_(std::move(options)) {
  std::array<char, 128> name{};
  if (::openpty(&master_, &slave_, name.data(), nullptr, nullptr) != 0)
    throw std::runtime_error("no pty");
  termios raw{};
  ::tcgetattr(slave_, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(slave_, TCSANOW, &raw);
  address_ = name.data();
  if (options_.banner_at_start) banner_due_ns_ = from_now(options_.banner_delay_s);
  thread_ = std::thread([this] { run(); });
}

GrblDouble::~GrblDouble() {
  ending_ = true;
  thread_.join();
  if (master_ >= 0) ::close(master_);
  if (slave_ >= 0) ::close(slave_);
}

void GrblDouble::run() {
  while (!ending_) {
    pollfd waiting{-1, POLLIN, 0};
    {
      const std::lock_guard lock(mutex_);
      waiting.fd = master_;
    }
    ::poll(&waiting, 1, 1);
    const std::lock_guard lock(mutex_);
    if (master_ < 0) continue;
    std::array<char, 256> bytes{};
    const ssize_t count =
        (waiting.revents & POLLIN) != 0 ? ::read(master_, bytes.data(), bytes.size()) : 0;
    for (ssize_t at = 0; at < count; ++at) take_byte(bytes[static_cast<std::size_t>(at)]);
    if (banner_due_ns_ != 0 && now_ns() >= banner_due_ns_) {
      banner_due_ns_ = 0;
      say(options_.banner);
    }
    if (homed_due_ns_ != 0 && now_ns() >= homed_due_ns_) finish_homing();
  }
}

void GrblDouble::take_byte(char byte) {
  note_real_time(byte, lines_);
  if (byte == '\x18') return reset();
  if (silent_ || until_reset_) return;
  if (byte == '\x85') return cancel_turn();
  if (byte == '?') return report();
  if (byte != '\n') return line_.push_back(byte);
  lines_.push_back(line_);
  take_line(std::exchange(line_, {}));
}

void GrblDouble::take_line(const std::string& line) {
  for (const auto& [beginning, code] : options_.errors) {
    if (line.compare(0, beginning.size(), beginning) == 0)
      return say("error:" + std::to_string(code) + "\r\n");
  }
  if (line == "$$") {
    for (const auto& [key, value] : options_.settings)
      say("$" + std::to_string(key) + "=" + fixed(value, 3) + "\r\n");
    return say("ok\r\n");
  }
  if (line == "$X") {
    locked_ = false;
    return say("[MSG:Caution: Unlocked]\r\nok\r\n");
  }
  if (line == "$H") return start_homing();
  if (line.compare(0, 3, "$J=") == 0) return start_turn(line);
  say("error:20\r\n");
}

void GrblDouble::start_homing() {
  homed_due_ns_ = from_now(options_.homing_s);
}

void GrblDouble::finish_homing() {
  homed_due_ns_ = 0;
  ++homings_;
  if (const int alarm = std::exchange(options_.homing_alarm, 0); alarm != 0) {
    locked_ = true;
    return say("ALARM:" + std::to_string(alarm) + "\r\n" + options_.banner);
  }
  locked_ = false;
  turned_since_homing_ = false;
  const double switch_deg = -(options_.settings.at(130) - options_.settings.at(27));
  homed_at_deg_ = std::round(switch_deg * options_.settings.at(100)) / options_.settings.at(100);
  say("ok\r\n");
}

void GrblDouble::start_turn(const std::string& line) {
  double target = 0.0;
  double feed = 0.0;
  // NOLINTNEXTLINE(cert-err34-c)
  if (std::sscanf(line.c_str(), "$J=G53 G21 X%lf F%lf", &target, &feed) != 2)
    return say("error:16\r\n");
  if (locked_) return say("error:9\r\n");
  if (turning_now()) return say("error:8\r\n");
  if (target > 0.0 || target < -options_.settings.at(130)) return say("error:15\r\n");
  const double steps = options_.settings.at(100);
  turns_.push_back({from_now(options_.turn_delay_s), machine_now(),
                    std::round(target * steps) / steps, feed / 60.0, options_.settings.at(120)});
  turned_since_homing_ = true;
  say("ok\r\n");
}

void GrblDouble::cancel_turn() {
  if (!ignores_cancel_ && turning_now() && turns_.back().cancelled_ns == 0)
    turns_.back().cancelled_ns = now_ns();
}

void GrblDouble::cut() {
  if (turning_now()) turns_.back().cut_ns = now_ns();
}

void GrblDouble::reset() {
  if (!options_.answers_reset) return;
  if (turning_now()) say("ALARM:3\r\n");
  boot();
}

void GrblDouble::boot() {
  cut();
  line_.clear();
  locked_ = true;
  silent_ = until_reset_ = false;
  first_report_ = true;
  homed_due_ns_ = 0;
  banner_due_ns_ = from_now(options_.banner_delay_s);
}

void GrblDouble::raise_alarm(int code) {
  const std::lock_guard lock(mutex_);
  cut();
  locked_ = true;
  until_reset_ = code == 1 || code == 2;
  say("ALARM:" + std::to_string(code) + "\r\n");
}

void GrblDouble::reset_itself() {
  const std::lock_guard lock(mutex_);
  boot();
}

void GrblDouble::fall_silent() {
  const std::lock_guard lock(mutex_);
  silent_ = true;
}

void GrblDouble::stop_short() {
  const std::lock_guard lock(mutex_);
  cut();
}

void GrblDouble::unplug() {
  const std::lock_guard lock(mutex_);
  ::close(std::exchange(master_, -1));
}

void GrblDouble::deafen_to_cancel() {
  const std::lock_guard lock(mutex_);
  ignores_cancel_ = true;
}

bool GrblDouble::turning() const {
  const std::lock_guard lock(mutex_);
  return turning_now() || homed_due_ns_ != 0;
}

std::vector<IdealTurn> GrblDouble::turns() const {
  const std::lock_guard lock(mutex_);
  return turns_;
}

std::vector<std::string> GrblDouble::lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

double GrblDouble::machine_deg() const {
  const std::lock_guard lock(mutex_);
  return machine_now();
}

int GrblDouble::homings() const {
  const std::lock_guard lock(mutex_);
  return homings_;
}

void GrblDouble::report() {
  if (homed_due_ns_ != 0 || banner_due_ns_ != 0) return;  // deaf while it homes or boots
  const char* const state = locked_ ? "Alarm" : turning_now() ? "Jog" : "Idle";
  const double speed = turning_now() ? turns_.back().speed_at(now_ns()) : 0.0;
  const double offset = options_.report_work_position ? 7.0 : 0.0;
  std::string text =
      std::string("<") + state + (options_.report_work_position ? "|WPos:" : "|MPos:") +
      fixed(machine_now() - offset, 3) + ",0.000,0.000|FS:" + fixed(speed * 60.0, 0) + ",0";
  if (std::exchange(first_report_, false)) text += "|WCO:" + fixed(offset, 3) + ",0.000,0.000";
  say(text + ">\r\n");
}

void GrblDouble::say(const std::string& text) {
  if (silent_ || master_ < 0) return;
  if (::write(master_, text.data(), text.size()) < 0) throw std::runtime_error("pty write");
}

bool GrblDouble::turning_now() const {
  return !turns_.empty() && now_ns() < turns_.back().end_ns();
}

double GrblDouble::machine_now() const {
  if (!turned_since_homing_) return homed_at_deg_;
  return turns_.back().angle_deg(std::min(now_ns(), turns_.back().end_ns()));
}

}  // namespace swivel::test
