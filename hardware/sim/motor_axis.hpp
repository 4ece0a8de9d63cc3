// The motor that a GRBL controller drives: degrees of MPos in, the true shaft angle out.
#pragma once

#include <array>
#include <cstdint>

#include "hardware/sim/grbl_settings.hpp"
#include "hardware/sim/motion.hpp"
#include "hardware/sim/random.hpp"
#include "hardware/sim/shaft.hpp"

namespace swivel::sim {

// An encoder on the shaft: MPos is then what it says, in place of the steps sent out.
struct EncoderOptions {
  bool present = false;
  double step_deg = 0.01;
  // From `?` to its answer. The angle is of some instant between the two.
  double latency_min_ms = 0.5;
  double latency_max_ms = 4.0;
};

struct MotorOptions {
  ShaftOptions shaft;
  double home_angle_deg = -75.0;  // of the shaft once homed, on average
  double home_sigma_deg = 0.35;   // of the photoelectric switch, drawn at every homing
  double home_time_s = 4.0;
  bool switch_works = true;
  double start_latency_min_ms = 5.0;  // from `ok` to the first step
  double start_latency_max_ms = 30.0;
  double crystal_ppm = 0.0;   // the controller's clock runs fast by this, and so do speeds
  double boot_s = 0.2;        // from opening the port, which resets the controller, to the banner
  int lose_every = 0;         // each Nth step is lost; 0 for none
  double lose_after_s = 0.0;  // from this long after the start of the bench
  double travel_deg = 360.0;  // $130 as shipped
  EncoderOptions encoder;
};

enum class HomeSwitch { kWorks, kOpen, kClosed };  // the latter two always

class MotorAxis {
 public:
  MotorAxis(const MotorOptions& options, std::uint64_t seed, std::int64_t now_ns);

  void move_to(double target_deg, double speed_deg_s, const GrblSettings& settings,
               std::int64_t now_ns);
  void brake(std::int64_t now_ns) { motion_.brake(now_ns); }
  void resume(std::int64_t now_ns) { motion_.resume(now_ns); }
  void forget_moves() { motion_.forget_moves(); }
  void halt(std::int64_t now_ns) { motion_.halt(now_ns); }
  void lose_steps(double angle_deg, std::int64_t now_ns);  // the shaft stays behind by this
  HomeSwitch home_switch() const { return home_switch_; }
  void set_switch(HomeSwitch home_switch) { home_switch_ = home_switch; }
  void zero_position(std::int64_t now_ns);  // MPos is 0 here, as after power-up

  // Seek, back off, find again, back off: the ends of the four phases.
  std::array<std::int64_t, 4> begin_homing(const GrblSettings& settings, std::int64_t now_ns);
  void finish_homing(const GrblSettings& settings, std::int64_t now_ns);

  bool moving(std::int64_t now_ns) const { return motion_.moving(now_ns); }
  int queued(std::int64_t now_ns);
  double position_deg(const GrblSettings& settings, std::int64_t now_ns) const;  // MPos
  double planned_end_deg(const GrblSettings& settings) const;
  double believed_speed_deg_s(const GrblSettings& settings, std::int64_t now_ns) const;
  bool at_switch(const GrblSettings& settings, std::int64_t now_ns) const;

  double shaft_angle_deg(std::int64_t time_ns) const;  // the truth

 private:
  double clock_gain() const { return 1.0 + options_.crystal_ppm * 1e-6; }

  MotorOptions options_;
  Random random_;
  Motion motion_;
  double origin_steps_ = 0.0;  // where MPos is 0
  double encoder_origin_deg_ = 0.0;
  double home_error_deg_ = 0.0;
  HomeSwitch home_switch_;
};

}  // namespace swivel::sim
