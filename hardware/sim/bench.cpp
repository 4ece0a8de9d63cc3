#include "hardware/sim/bench.hpp"

#include <algorithm>
#include <vector>

#include "hardware/sim/poll_until.hpp"

namespace swivel::sim {

Bench::Bench(const BenchOptions& options)
    : start_ns_(now_ns()),
      world_(options.world),
      lidar_(options.lidar, world_, options.seed),
      timing_(options.timing, start_ns_, options.lidar.sensor.steps_per_turn,
              options.lidar.sensor.last_step - options.lidar.sensor.first_step, options.seed),
      stepper_(options.motor, options.seed, start_ns_),
      sensor_(options.lidar.sensor, timing_, std::llround(options.timing.start_latency_ms * 1e6)),
      truth_(options.truth_path),
      server_(options.server, sensor_, timing_,
              [this](std::uint64_t scan) { return cast_scan(scan); }),
      stepper_port_(stepper_, options.stepper_link),
      control_(options.control_path),
      lowest_deg_(stepper_.shaft_angle_deg(start_ns_)),
      highest_deg_(lowest_deg_) {
  note_truth(options);
}

void Bench::note_truth(const BenchOptions& options) {
  truth_.note("seed", options.seed);
  truth_.note("alpha_deg", options.world.plate.alpha_deg);
  truth_.note("scan_period_ns", timing_.scan_period_ns());
  note_placement("axis", options.lidar.axis);
  note_placement("mounting", options.lidar.mounting);
  truth_.note("bias_deg", options.lidar.bias_deg);
  truth_.note("noise_mm", options.lidar.noise_mm);
  const RoomOptions& room = options.world.room;
  truth_.note("room_front_mm", room.front_mm);
  truth_.note("room_back_mm", room.back_mm);
  truth_.note("room_left_mm", room.left_mm);
  truth_.note("room_right_mm", room.right_mm);
  truth_.note("room_floor_mm", room.floor_mm);
  truth_.note("room_roof_mm", room.roof_mm);
  truth_.note("room_yaw_deg", room.yaw_deg);
  truth_.note("room_front_skew_deg", room.front_skew_deg);
  truth_.begin_rows();
}

void Bench::note_placement(const std::string& what, const Placement& placement) {
  truth_.note(what + "_x_mm", placement.xyz_mm.x);
  truth_.note(what + "_y_mm", placement.xyz_mm.y);
  truth_.note(what + "_z_mm", placement.xyz_mm.z);
  truth_.note(what + "_roll_deg", placement.rpy_deg.x);
  truth_.note(what + "_pitch_deg", placement.rpy_deg.y);
  truth_.note(what + "_yaw_deg", placement.rpy_deg.z);
}

LineReading Bench::cast_scan(std::uint64_t scan) {
  const std::int64_t beam0_ns = timing_.beam0_time_ns(scan);
  truth_.row(timing_.stamp_ms(scan), beam0_ns, stepper_.shaft_angle_deg(beam0_ns));
  ++lines_sent_;
  return lidar_.cast_line({scan, beam0_ns, timing_.beam_period_ns()}, [this](std::int64_t time_ns) {
    return stepper_.shaft_angle_deg(time_ns) * kRadPerDeg;
  });
}

void Bench::run(const WakeUp& stop) {
  while (!is_notified(stop)) {
    // The stepper first: what it is told at an instant counts for the beams from then on.
    const std::int64_t time_ns = now_ns();
    stepper_port_.serve(time_ns);
    server_.serve(time_ns);
    note_shaft(time_ns);
    control_.serve([&](const std::string& command) { return obey(command, time_ns); });
    wait(stop);
  }
}

void Bench::note_shaft(std::int64_t now_ns) {
  const double angle_deg = stepper_.shaft_angle_deg(now_ns);
  lowest_deg_ = std::min(lowest_deg_, angle_deg);
  highest_deg_ = std::max(highest_deg_, angle_deg);
}

void Bench::wait(const WakeUp& stop) const {
  const std::int64_t time_ns = now_ns();
  std::vector<pollfd> waits = {{stop.descriptor(), POLLIN, 0}};
  server_.add_to(waits, time_ns);
  stepper_port_.add_to(waits);
  control_.add_to(waits);
  poll_until(std::min(server_.next_event_ns(), stepper_port_.next_event_ns(time_ns)), waits);
}

}  // namespace swivel::sim
