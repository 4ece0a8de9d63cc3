// A session with a GRBL 1.1 controller that turns the lidar: one axis, X, in degrees.
//
// connect, home, then move_to as often as wanted. Angles are axis angles: home_angle_deg at
// the home switch (that is, where homing leaves the shaft), growing in GRBL's positive
// direction. They count the steps sent out: GRBL does not see the shaft.
// After an alarm, a reset or a lost connection nothing moves before connect and home.
// For one thread; `stop` may be notified from another and ends every wait, but those of halt.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hardware/io/byte_stream.hpp"
#include "hardware/stepper/grbl.hpp"
#include "hardware/stepper/motor_guard.hpp"
#include "hardware/stepper/stepper_settings.hpp"

namespace swivel {

struct GrblStepperOptions {
  std::string address;  // as ByteStream::open takes it
  TurnLimits limits;
  std::string guard_program;  // stops the motor should this process die; empty: nothing does
  std::chrono::milliseconds banner_timeout{2500};  // an Arduino's boot loader takes 2 s
  std::chrono::milliseconds reply_timeout{1000};
  std::chrono::milliseconds status_timeout{500};
  std::chrono::milliseconds homing_timeout{60000};
  std::chrono::milliseconds halt_timeout{800};  // for the shaft to run down; then it is cut
  WireTap tap;  // of every connection; it does not see the guard's two bytes
};

struct StepperStatus {
  GrblState state = GrblState::kAlarm;
  double angle_deg = 0.0;     // NaN before homing
  double speed_deg_s = 0.0;   // the planner's
  std::int64_t asked_ns = 0;  // the instant of state and angle lies between these two
  std::int64_t answered_ns = 0;
};

// A turn that the controller has taken.
struct Turn {
  double end_angle_deg = 0.0;    // of whole steps
  std::int64_t sent_ns = 0;      // just before the line was written
  std::int64_t accepted_ns = 0;  // its ok was read: the motor starts about now
};

class GrblStepper {
 public:
  explicit GrblStepper(GrblStepperOptions options, const WakeUp* stop = nullptr);
  ~GrblStepper();  // a motor that may still turn is cut
  GrblStepper(const GrblStepper&) = delete;
  GrblStepper& operator=(const GrblStepper&) = delete;

  // Opens, waits for the banner (an Arduino resets when its port is opened; what does not is
  // reset by 0x18), reads and checks the settings. Again after a failure: a fresh start.
  Outcome connect();
  Outcome unlock();  // ends GRBL's lock; moving still needs home()
  Outcome home();
  Outcome check_move(double angle_deg, double speed_deg_s) const;
  Result<Turn> move_to(double angle_deg, double speed_deg_s);  // returns once it is taken
  Outcome cancel();                                            // runs down; returns at once
  Result<StepperStatus> status();
  Result<StepperStatus> wait_idle(std::chrono::milliseconds timeout);

  // Ends any motion: cancels, and resets the controller when it still turns after
  // halt_timeout or does not answer. Fails when it cannot tell that the motor stands still.
  Outcome halt();

  bool homed() const { return homed_; }
  const StepperSettings& settings() const { return settings_; }  // since connect()
  const std::string& firmware() const { return firmware_; }
  std::uint64_t garbage_lines() const { return garbage_before_ + parser_.garbage_lines(); }

 private:
  using Milliseconds = std::chrono::milliseconds;
  enum class Heard { kYes, kSilence, kInterrupted, kLost };

  Outcome open_port();
  Outcome check_guard();
  Outcome write(std::string_view bytes);
  Heard listen(Milliseconds timeout, const std::function<bool()>& heard, const WakeUp* stop);
  void pause_listening(Milliseconds pause, const WakeUp* stop);
  Outcome command(const std::string& line, Milliseconds timeout);
  Outcome ask_status(Milliseconds timeout, const WakeUp* stop);
  Outcome await_banner();
  Outcome reset(Milliseconds timeout, const WakeUp* stop);
  Outcome read_settings();
  Outcome find_home();
  Outcome run_down();
  void forget_connection();
  void lose(const std::string& reason);
  Failure unheard(Heard heard, const std::string& waited_for);
  std::string why_no_banner() const;
  std::optional<std::string> trouble() const;
  double angle_of(const GrblStatus& report) const;
  void take(const GrblMessage& message);
  void take_status(const GrblStatus& status);

  GrblStepperOptions options_;
  const WakeUp* stop_;
  std::optional<ByteStream> stream_;
  std::optional<MotorGuard> guard_;  // of that port
  std::string lost_reason_;
  GrblParser parser_;
  StepperSettings settings_;
  std::string firmware_;
  double home_machine_deg_ = 0.0;
  double work_offset_deg_ = 0.0;
  bool homed_ = false;
  bool may_turn_ = false;             // was told to move, and is not known to stand still
  std::uint64_t garbage_before_ = 0;  // in connections before this one

  // Heard and not yet asked for.
  std::optional<int> answer_;  // 0 for ok, else the error
  std::optional<GrblStatus> report_;
  std::optional<int> alarm_;
  bool was_reset_ = false;
  std::map<int, double> setting_values_;
};

}  // namespace swivel
