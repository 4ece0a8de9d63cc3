// The half of the session that writes, listens and remembers what it heard.
#include <algorithm>

#include "hardware/stepper/grbl_stepper.hpp"

namespace swivel {
namespace {

constexpr std::chrono::milliseconds kWriteTimeout{200};
constexpr std::chrono::milliseconds kHangUpTimeout{1};

}  // namespace

void GrblStepper::forget_connection() {
  guard_.reset();  // the port's lock is also the guard's
  stream_.reset();
  garbage_before_ += parser_.garbage_lines();
  parser_ = GrblParser();
  homed_ = false;
  was_reset_ = false;
  alarm_.reset();
}

Outcome GrblStepper::write(std::string_view bytes) {
  if (!stream_) return Failure{options_.address + ": not connected"};
  Outcome written = stream_->write_all(bytes, kWriteTimeout);
  if (written) return written;
  homed_ = false;
  pause_listening(kHangUpTimeout, nullptr);  // hears whether the other side is gone, or hangs
  return written;
}

void GrblStepper::lose(const std::string& reason) {
  lost_reason_ = reason;
  stream_.reset();
  homed_ = false;
}

GrblStepper::Heard GrblStepper::listen(Milliseconds timeout, const std::function<bool()>& heard,
                                       const WakeUp* stop) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + timeout;
  while (!heard()) {
    const auto left = std::chrono::ceil<Milliseconds>(deadline - Clock::now());
    if (left <= Milliseconds::zero()) return Heard::kSilence;  // even amid chatter
    const Received received = stream_->read_some(left, stop);
    if (received.kind == Received::Kind::kInterrupted) return Heard::kInterrupted;
    if (received.kind == Received::Kind::kClosed || received.kind == Received::Kind::kError) {
      lose(received.reason);
      return Heard::kLost;
    }
    for (const GrblMessage& message : parser_.push(received.bytes)) take(message);
  }
  return Heard::kYes;
}

void GrblStepper::pause_listening(Milliseconds pause, const WakeUp* stop) {
  if (stream_)
    listen(
        pause, [this] { return trouble().has_value(); }, stop);
}

Failure GrblStepper::unheard(Heard heard, const std::string& waited_for) {
  if (heard == Heard::kLost) return {options_.address + ": " + lost_reason_};
  if (heard == Heard::kInterrupted) return {"stopped while waiting for " + waited_for};
  homed_ = false;  // whoever is silent may have lost its position
  return {options_.address + ": the controller is silent (" + waited_for +
          " did not come); check its power and cable"};
}

Outcome GrblStepper::command(const std::string& line, Milliseconds timeout) {
  if (const auto reason = trouble()) return Failure{*reason};
  answer_.reset();
  Outcome written = write(line);
  if (!written) return written;
  const Heard heard = listen(
      timeout, [this] { return answer_ || trouble(); }, stop_);
  if (heard != Heard::kYes)
    return unheard(heard, "the answer to " + line.substr(0, line.find_first_of(" =\n")));
  if (const auto reason = trouble()) return Failure{*reason};
  if (*answer_ != 0) return Failure{"the controller refuses, " + grbl_error_words(*answer_)};
  return Done{};
}

Outcome GrblStepper::ask_status(Milliseconds timeout, const WakeUp* stop) {
  if (const auto reason = trouble()) return Failure{*reason};
  report_.reset();
  Outcome written = write(std::string(1, kGrblStatusQuery));
  if (!written) return written;
  const Heard heard = listen(
      timeout, [this] { return report_ || trouble(); }, stop);
  if (heard != Heard::kYes) return unheard(heard, "a status report");
  if (const auto reason = trouble()) return Failure{*reason};
  return Done{};
}

std::optional<std::string> GrblStepper::trouble() const {
  if (alarm_) return grbl_alarm_words(*alarm_);
  if (was_reset_)
    return "the controller was reset (its power or its cable?), so its position is lost; home it";
  return std::nullopt;
}

void GrblStepper::take(const GrblMessage& message) {
  if (std::holds_alternative<GrblOk>(message)) answer_ = 0;
  if (const auto* error = std::get_if<GrblError>(&message)) answer_ = error->code;
  if (const auto* setting = std::get_if<GrblSetting>(&message))
    setting_values_[setting->number] = setting->value;
  if (const auto* status = std::get_if<GrblStatus>(&message)) take_status(*status);
  if (const auto* alarm = std::get_if<GrblAlarm>(&message)) {
    alarm_ = alarm->code;
    homed_ = false;
  }
  if (const auto* banner = std::get_if<GrblBanner>(&message)) {
    firmware_ = banner->version;
    was_reset_ = true;
    homed_ = false;
    may_turn_ = false;  // a controller that starts drives nothing
    work_offset_deg_ = 0.0;
  }
}

void GrblStepper::take_status(const GrblStatus& status) {
  report_ = status;
  if (status.work_offset_deg) work_offset_deg_ = *status.work_offset_deg;
  if (status.state == GrblState::kAlarm) homed_ = false;
}

}  // namespace swivel
