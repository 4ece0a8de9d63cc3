#include "hardware/sim/motor_axis.hpp"

#include <algorithm>
#include <cmath>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr double kSlowestStepsS = 30.0;  // GRBL does not go slower, though it says so
constexpr std::uint64_t kMotorStream = 0x4070;

}  // namespace

MotorAxis::MotorAxis(const MotorOptions& options, std::uint64_t seed, std::int64_t now_ns)
    : options_(options),
      random_(seed, kMotorStream),
      motion_(now_ns, {options.lose_every, now_ns + ns_from_s(options.lose_after_s)}),
      home_switch_(options.switch_works ? HomeSwitch::kWorks : HomeSwitch::kOpen) {}

void MotorAxis::move_to(double target_deg, double speed_deg_s, const GrblSettings& settings,
                        std::int64_t now_ns) {
  const double believed =
      std::min(speed_deg_s, settings.fastest_deg_s()) * settings.steps_per_deg();
  Move move;
  move.target_steps = origin_steps_ + std::round(target_deg * settings.steps_per_deg());
  move.believed_speed_steps_s = believed;
  move.speed_steps_s = std::max(believed, kSlowestStepsS) * clock_gain();
  const double acceleration = settings.acceleration_deg_s2() * settings.steps_per_deg();
  const double latency_ms =
      random_.uniform(options_.start_latency_min_ms, options_.start_latency_max_ms);
  motion_.add(move, acceleration * clock_gain() * clock_gain(), now_ns,
              now_ns + ns_from_s(latency_ms * 1e-3));
}

void MotorAxis::lose_steps(double angle_deg, std::int64_t now_ns) {
  motion_.lose(std::round(angle_deg * options_.shaft.steps_per_turn / 360.0), now_ns);
}

void MotorAxis::zero_position(std::int64_t now_ns) {
  motion_.halt(now_ns);
  origin_steps_ = motion_.position_at(now_ns);
  encoder_origin_deg_ = shaft_angle_deg(now_ns);
}

std::array<std::int64_t, 4> MotorAxis::begin_homing(const GrblSettings& settings,
                                                    std::int64_t now_ns) {
  motion_.halt(now_ns);
  home_error_deg_ = options_.home_sigma_deg * random_.gaussian();
  const double home = motor_steps(options_.shaft, options_.home_angle_deg + home_error_deg_) +
                      motion_.lost_steps_now();
  const double pull_off = settings.pull_off_deg() * options_.shaft.steps_per_turn / 360.0;
  const std::array<double, 4> shares = {0.7, 0.1, 0.15, 0.05};
  const std::array<double, 4> targets = {home - pull_off, home, home - pull_off, home};
  std::array<std::int64_t, 4> ends{};
  std::int64_t start_ns = now_ns;
  for (std::size_t phase = 0; phase < ends.size(); ++phase) {
    const double duration_s = shares[phase] * options_.home_time_s;
    motion_.glide(targets[phase], duration_s, start_ns);
    start_ns = ends[phase] = start_ns + ns_from_s(duration_s);
  }
  return ends;
}

// The switch decides where home is, however many steps were lost on the way.
void MotorAxis::finish_homing(const GrblSettings& settings, std::int64_t now_ns) {
  motion_.halt(now_ns);
  const double home = motor_steps(options_.shaft, options_.home_angle_deg + home_error_deg_);
  motion_.place(std::round(home) + motion_.lost_steps_now(), now_ns);
  origin_steps_ = motion_.position_at(now_ns) -
                  std::round(settings.homed_position_deg() * settings.steps_per_deg());
  encoder_origin_deg_ = shaft_angle_deg(now_ns) - settings.homed_position_deg();
}

int MotorAxis::queued(std::int64_t now_ns) {
  motion_.drop_finished(now_ns);
  return static_cast<int>(motion_.moves().size());
}

double MotorAxis::position_deg(const GrblSettings& settings, std::int64_t now_ns) const {
  if (options_.encoder.present) {
    const double measured_deg = shaft_angle_deg(now_ns) - encoder_origin_deg_;
    return std::round(measured_deg / options_.encoder.step_deg) * options_.encoder.step_deg;
  }
  return (std::round(motion_.position_at(now_ns)) - origin_steps_) / settings.steps_per_deg();
}

double MotorAxis::planned_end_deg(const GrblSettings& settings) const {
  return (motion_.end_steps() - origin_steps_) / settings.steps_per_deg();
}

double MotorAxis::believed_speed_deg_s(const GrblSettings& settings, std::int64_t now_ns) const {
  double speed_steps_s = std::abs(motion_.speed_at(now_ns)) / clock_gain();
  if (!motion_.moves().empty()) {
    speed_steps_s = std::min(speed_steps_s, motion_.moves().front().believed_speed_steps_s);
  }
  return speed_steps_s / settings.steps_per_deg();
}

bool MotorAxis::at_switch(const GrblSettings& settings, std::int64_t now_ns) const {
  const double switch_deg = options_.home_angle_deg + home_error_deg_ - settings.pull_off_deg();
  if (home_switch_ == HomeSwitch::kClosed) return true;
  return home_switch_ == HomeSwitch::kWorks && shaft_angle_deg(now_ns) <= switch_deg + 1e-9;
}

double MotorAxis::shaft_angle_deg(std::int64_t time_ns) const {
  return swivel::sim::shaft_angle_deg(options_.shaft, motion_.motor_steps_at(time_ns));
}

}  // namespace swivel::sim
