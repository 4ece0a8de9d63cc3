// A controller that answers as GRBL 1.1h does, for one axis. Bytes in, bytes out; pure: time
// is an argument, and never goes back.
//
// Known differences from the firmware: a feed hold ends a jog (as in the firmware) and pauses
// G0 and G1; there are no overrides, probes, spindle, startup lines or check mode.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "hardware/sim/grbl_settings.hpp"
#include "hardware/sim/grbl_words.hpp"
#include "hardware/sim/motor_axis.hpp"
#include "hardware/sim/serial_device.hpp"
#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {

constexpr std::int64_t kAlarmSilence_ns = 500 * kMillisecond_ns;

class GrblPeer : public SerialDevice {
 public:
  GrblPeer(const MotorOptions& options, std::uint64_t seed, std::int64_t now_ns);

  void power_up(std::int64_t now_ns) override;
  void receive(std::string_view bytes, std::int64_t now_ns) override;
  void advance(std::int64_t now_ns) override;
  std::string take_output() override;
  std::int64_t next_event_ns(std::int64_t now_ns) const override;

  // Faults from now on.
  void raise_alarm(int number, std::int64_t now_ns);  // 1 and 2 keep it deaf until a reset
  void lose_steps(double angle_deg, std::int64_t now_ns) { axis_.lose_steps(angle_deg, now_ns); }
  void set_switch(HomeSwitch home_switch) { axis_.set_switch(home_switch); }

  // Something may come of itself, one does not know when.
  bool busy(std::int64_t now_ns) const;

  double shaft_angle_deg(std::int64_t time_ns) const { return axis_.shaft_angle_deg(time_ns); }
  std::uint64_t bytes_lost() const { return bytes_lost_; }  // sent into a full buffer

 private:
  enum class State { kIdle, kRun, kJog, kHold, kHome, kAlarm, kSleep };

  void take_byte(char byte, std::int64_t now_ns);
  void hold(std::int64_t now_ns);
  void resume(std::int64_t now_ns);
  void cancel_jog(std::int64_t now_ns);
  void reset(std::int64_t now_ns);
  void restart(std::int64_t quiet_ns, std::int64_t now_ns);
  void greet();
  void alarm(int number);  // that only a reset ends
  void advance_homing(std::int64_t now_ns);
  void advance_motion(std::int64_t now_ns);
  void take_lines(std::int64_t now_ns);

  void answer(GrblError error);
  void execute_line(const std::string& line, std::int64_t now_ns);
  GrblError execute_system_line(const std::string& line, std::int64_t now_ns);
  GrblError begin_homing(std::int64_t now_ns);
  GrblError unlock();
  GrblError sleep();
  GrblError change_setting(std::string_view assignment);
  GrblError execute_jog(std::string_view text, std::int64_t now_ns);
  GrblError execute_motion(std::string_view text, std::int64_t now_ns);
  double target_deg(const GrblWords& words, bool absolute) const;
  bool beyond_travel(double target_deg) const;

  void take_status_request(std::int64_t now_ns);
  std::string status_report(std::int64_t now_ns);
  std::string state_name(std::int64_t now_ns) const;
  bool in_motion_state() const;

  MotorOptions options_;
  GrblSettings settings_;
  MotorAxis axis_;
  Random latency_;
  State state_ = State::kIdle;
  std::string received_;
  std::string output_;
  std::int64_t quiet_until_ns_ = 0;
  std::string after_quiet_;  // said when the silence ends
  bool dead_ = false;        // after a hard or soft limit: only a reset is heard
  bool reset_requested_ = false;
  bool status_requested_ = false;
  std::int64_t report_due_ns_ = 0;  // of the request
  std::int64_t report_of_ns_ = 0;
  bool absolute_ = true;
  int motion_word_ = 0;
  double feed_per_min_ = 0.0;
  std::array<std::int64_t, 4> homing_ends_ns_{};
  std::size_t homing_phase_ = 0;
  int reports_to_offset_ = 0;
  int reports_to_override_ = 0;
  std::uint64_t bytes_lost_ = 0;
};

}  // namespace swivel::sim
