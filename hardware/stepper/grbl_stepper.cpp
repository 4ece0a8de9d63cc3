#include "hardware/stepper/grbl_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};
// Longer than the 500 ms of silence after an alarm, which a reset in motion is.
constexpr std::chrono::milliseconds kCutTimeout{700};

bool turns(GrblState state) {
  return state == GrblState::kJog || state == GrblState::kRun || state == GrblState::kHome;
}

std::string machine_state(GrblState state) {
  return std::string("the controller is in state ") + grbl_state_name(state);
}

}  // namespace

GrblStepper::GrblStepper(GrblStepperOptions options, const WakeUp* stop)
    : options_(std::move(options)), stop_(stop) {}

GrblStepper::~GrblStepper() {
  if (may_turn_) write(std::string(1, kGrblReset));
}

Outcome GrblStepper::connect() {
  forget_connection();
  Outcome opened = open_port();
  if (!opened) return opened;
  Outcome banner = await_banner();
  if (!banner) return banner;
  if (firmware_.compare(0, 3, "1.1") != 0) {
    return Failure{options_.address + ": the controller is GRBL " + firmware_ +
                   "; load GRBL 1.1 into it"};
  }
  return read_settings();
}

Outcome GrblStepper::open_port() {
  Result<ByteStream> opened =
      ByteStream::open(options_.address, options_.reply_timeout, stop_, options_.tap);
  if (!opened) return Failure{opened.reason()};
  stream_ = std::move(*opened);
  if (options_.guard_program.empty()) return Done{};
  Result<MotorGuard> guard = MotorGuard::start(options_.guard_program, stream_->descriptor());
  if (!guard) return Failure{guard.reason()};
  guard_ = std::move(*guard);
  return Done{};
}

Outcome GrblStepper::check_guard() {
  if (options_.guard_program.empty() || (guard_ && guard_->watches())) return Done{};
  return Failure{"the motor's guard is gone: without it nothing moves"};
}

Outcome GrblStepper::await_banner() {
  const auto banner_came = [this] { return was_reset_; };
  const Heard heard = listen(options_.banner_timeout, banner_came, stop_);
  if (heard == Heard::kSilence) {
    Outcome started_afresh = reset(options_.banner_timeout, stop_);
    if (!started_afresh) return started_afresh;
  } else if (heard != Heard::kYes) {
    return unheard(heard, "its banner");
  }
  was_reset_ = false;
  alarm_.reset();
  return Done{};
}

Outcome GrblStepper::reset(Milliseconds timeout, const WakeUp* stop) {
  was_reset_ = false;
  Outcome written = write(std::string(1, kGrblReset));
  if (!written) return written;
  const Heard heard = listen(
      timeout, [this] { return was_reset_; }, stop);
  if (heard == Heard::kSilence) return Failure{options_.address + ": " + why_no_banner()};
  if (heard != Heard::kYes) return unheard(heard, "its banner");
  return Done{};
}

std::string GrblStepper::why_no_banner() const {
  if (parser_.bytes_received() == 0)
    return "nothing answers there; is this the controller's port, and is it powered?";
  return "what answers there is not GRBL 1.1, or talks at another baud rate (115200 is usual)";
}

Outcome GrblStepper::read_settings() {
  setting_values_.clear();
  Outcome listed = command("$$\n", options_.reply_timeout);
  if (!listed) return listed;
  Result<StepperSettings> settings = read_stepper_settings(setting_values_);
  if (!settings) return Failure{options_.address + ": " + settings.reason()};
  settings_ = std::move(*settings);
  for (std::string& advice : advice_on_limits(options_.limits, settings_)) {
    settings_.advice.push_back(std::move(advice));
  }
  return Done{};
}

Outcome GrblStepper::unlock() {
  if (alarm_) {  // some alarms lock out even $X
    Outcome fresh = reset(options_.banner_timeout, stop_);
    if (!fresh) return fresh;
  }
  alarm_.reset();
  was_reset_ = false;
  return command("$X\n", options_.reply_timeout);
}

Outcome GrblStepper::home() {
  homed_ = false;
  Outcome unlocked = unlock();
  if (!unlocked) return unlocked;
  Outcome guarded = check_guard();
  if (!guarded) return guarded;
  may_turn_ = true;
  Outcome found = find_home();
  if (!found && may_turn_) write(std::string(1, kGrblReset));  // nothing else ends homing
  return found;
}

Outcome GrblStepper::find_home() {
  Outcome homing = command("$H\n", options_.homing_timeout);
  if (!homing) return Failure{"homing: " + homing.reason()};
  Outcome asked = ask_status(options_.status_timeout, stop_);
  if (!asked) return Failure{"homing: " + asked.reason()};
  if (report_->state != GrblState::kIdle)
    return Failure{"homing: " + machine_state(report_->state) + " after it"};
  if (!report_->machine_deg && !report_->work_deg)
    return Failure{"homing: the controller's reports hold no position; send $10=1"};
  const double reported_deg =
      report_->machine_deg.value_or(report_->work_deg.value_or(0.0) + work_offset_deg_);
  const double steps_per_deg = settings_.steps_per_deg;
  home_machine_deg_ = std::round(reported_deg * steps_per_deg) / steps_per_deg;
  homed_ = true;
  return Done{};
}

Outcome GrblStepper::check_move(double angle_deg, double speed_deg_s) const {
  if (const auto reason = trouble()) return Failure{*reason};
  if (!homed_) return Failure{"the shaft's angle is not known; home first"};
  return check_turn(options_.limits, settings_, home_machine_deg_, angle_deg, speed_deg_s);
}

Result<Turn> GrblStepper::move_to(double angle_deg, double speed_deg_s) {
  const Outcome allowed = check_move(angle_deg, speed_deg_s);
  if (!allowed) return Failure{allowed.reason()};
  const Outcome guarded = check_guard();
  if (!guarded) return Failure{guarded.reason()};
  Turn turn;
  turn.end_angle_deg = whole_steps_deg(options_.limits, settings_, angle_deg);
  const double machine_deg =
      home_machine_deg_ + turn.end_angle_deg - options_.limits.home_angle_deg;
  may_turn_ = true;
  turn.sent_ns = now_ns();
  Outcome taken = command(grbl_jog_line(machine_deg, speed_deg_s), options_.reply_timeout);
  if (!taken) return Failure{"the turn was not taken: " + taken.reason()};
  turn.accepted_ns = now_ns();
  return turn;
}

Outcome GrblStepper::cancel() {
  return write(std::string(1, kGrblJogCancel));
}

Result<StepperStatus> GrblStepper::status() {
  const std::int64_t asked_ns = now_ns();
  const Outcome answered = ask_status(options_.status_timeout, stop_);
  if (!answered) return Failure{answered.reason()};
  StepperStatus status;
  status.state = report_->state;
  status.angle_deg = angle_of(*report_);
  status.speed_deg_s = report_->speed_deg_s.value_or(0.0);
  status.asked_ns = asked_ns;
  status.answered_ns = now_ns();
  return status;
}

double GrblStepper::angle_of(const GrblStatus& report) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const double machine_deg =
      report.machine_deg.value_or(report.work_deg.value_or(kUnknown) + work_offset_deg_);
  if (!homed_) return kUnknown;
  return options_.limits.home_angle_deg + machine_deg - home_machine_deg_;
}

Result<StepperStatus> GrblStepper::wait_idle(Milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    Result<StepperStatus> now = status();
    if (!now || now->state == GrblState::kIdle) return now;
    if (!turns(now->state)) return Failure{machine_state(now->state)};
    if (std::chrono::steady_clock::now() >= deadline)
      return Failure{"the motor still turns after " + std::to_string(timeout.count()) + " ms"};
    pause_listening(kPollInterval, stop_);
  }
}

Outcome GrblStepper::halt() {
  if (!may_turn_) return Done{};
  if (!stream_)
    return Failure{options_.address + ": the controller is gone: a turn under way runs to its end"};
  if (!trouble() && run_down()) return Done{};
  Outcome cut = reset(kCutTimeout, nullptr);
  if (!cut) return Failure{"the motor may turn to the end of its turn: " + cut.reason()};
  return Done{};
}

Outcome GrblStepper::run_down() {
  const auto deadline = std::chrono::steady_clock::now() + options_.halt_timeout;
  Outcome cancelled = cancel();
  if (!cancelled) return cancelled;
  while (std::chrono::steady_clock::now() < deadline) {
    Outcome asked = ask_status(std::min(options_.status_timeout, options_.halt_timeout), nullptr);
    if (!asked) return asked;
    if (report_->state == GrblState::kIdle) return may_turn_ = false, Done{};
    pause_listening(kPollInterval, nullptr);
  }
  return Failure{"the motor still turns"};
}

}  // namespace swivel
