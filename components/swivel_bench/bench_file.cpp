#include "components/swivel_bench/bench_file.hpp"

#include <functional>

#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

constexpr Range kTilt{-45.0, 45.0};
constexpr Range kPlace{-30000.0, 30000.0};
constexpr Range kSize{0.1, 60000.0};
constexpr Range kNoise{0.0, 1000.0};
constexpr Range kRate{0.0, 1.0};
constexpr Range kTime{0.0, 100000.0};
constexpr Range kPpm{-100000.0, 100000.0};
constexpr Range kCount{0.0, 1e9};

// Each reader takes what the file says and leaves the rest as it is.
void read(YamlSection& section, const char* key, Range range, double& value) {
  value = section.number(key, range, value);
}
void read(YamlSection& section, const char* key, Range range, int& value) {
  value = section.integer(key, range, value);
}
void read(YamlSection& section, const char* key, bool& value) {
  value = section.flag(key, value);
}

void in_section(YamlSection& file, const std::string& key,
                const std::function<void(YamlSection&)>& read_section) {
  auto section = file.section_if_present(key);
  if (!section) return;
  read_section(*section);
  section->finish();
}

sim::Vector3 read_triple(YamlSection& section, const char* key, Range range,
                         const sim::Vector3& when_absent) {
  if (!section.has(key)) return when_absent;
  const auto values = section.numbers(key, 3, range);
  return {values[0], values[1], values[2]};
}

void read_placement(YamlSection& section, sim::Placement& placement) {
  placement.xyz_mm = read_triple(section, "xyz_mm", kPlace, placement.xyz_mm);
  placement.rpy_deg = read_triple(section, "rpy_deg", kAnyAngle_deg, placement.rpy_deg);
}

sim::Furniture read_furniture(YamlSection& section) {
  sim::Furniture piece;
  read(section, "x_mm", kPlace, piece.x_mm);
  read(section, "y_mm", kPlace, piece.y_mm);
  read(section, "yaw_deg", kAnyAngle_deg, piece.yaw_deg);
  read(section, "length_mm", kSize, piece.length_mm);
  read(section, "width_mm", kSize, piece.width_mm);
  read(section, "bottom_mm", kPlace, piece.bottom_mm);
  read(section, "top_mm", kPlace, piece.top_mm);
  read(section, "reflectivity", kRate, piece.reflectivity);
  if (piece.top_mm <= piece.bottom_mm) section.refuse("top_mm", "must be above bottom_mm");
  return piece;
}

void read_room(YamlSection& section, sim::RoomOptions& room) {
  read(section, "front_mm", kPlace, room.front_mm);
  read(section, "back_mm", kPlace, room.back_mm);
  read(section, "left_mm", kPlace, room.left_mm);
  read(section, "right_mm", kPlace, room.right_mm);
  read(section, "floor_mm", kPlace, room.floor_mm);
  read(section, "roof_mm", kPlace, room.roof_mm);
  read(section, "yaw_deg", kAnyAngle_deg, room.yaw_deg);
  read(section, "front_skew_deg", kTilt, room.front_skew_deg);
  in_section(section, "furniture", [&](YamlSection& pieces) {
    room.furniture.clear();
    for (const std::string& name : pieces.keys()) {
      in_section(pieces, name,
                 [&](YamlSection& piece) { room.furniture.push_back(read_furniture(piece)); });
    }
  });
}

void read_plate_of_bench(YamlSection& section, sim::PlateOptions& plate) {
  read(section, "present", plate.present);
  read(section, "alpha_deg", kAnyAngle_deg, plate.alpha_deg);
  read(section, "base_distance_mm", kSize, plate.base_distance_mm);
  read(section, "hypotenuse_mm", kSize, plate.hypotenuse_mm);
  read(section, "depth_mm", kSize, plate.depth_mm);
  read(section, "pitch_deg", kTilt, plate.pitch_deg);
  read(section, "roll_deg", kTilt, plate.roll_deg);
  read(section, "reflectivity", kRate, plate.reflectivity);
}

void read_clutter(YamlSection& section, sim::ClutterOptions& clutter) {
  read(section, "present", clutter.present);
  read(section, "azimuth_deg", kAnyAngle_deg, clutter.azimuth_deg);
  read(section, "distance_mm", kSize, clutter.distance_mm);
  read(section, "size_mm", kSize, clutter.size_mm);
}

void read_sensor(YamlSection& section, sim::SensorModel& sensor) {
  const std::string model = section.text("model", sensor.product);
  const auto known = sim::sensor_model(model);
  if (!known) section.refuse("model", "is none of UST-10LX, UTM-30LX, URG-04LX");
  sensor = *known;
  sensor.serial_number = section.text("serial_number", sensor.serial_number);
  read(section, "first_step", {0.0, 9998.0}, sensor.first_step);
  read(section, "last_step", {1.0, 9999.0}, sensor.last_step);
  read(section, "front_step", {0.0, 9999.0}, sensor.front_step);
  read(section, "steps_per_turn", {2.0, 100000.0}, sensor.steps_per_turn);
  if (sensor.last_step >= sensor.steps_per_turn) {
    section.refuse("last_step", "must be below steps_per_turn: a scan is less than a turn");
  }
  if (sensor.first_step >= sensor.last_step) {
    section.refuse("first_step", "must be below last_step");
  }
}

void read_lidar_of_bench(YamlSection& section, sim::LidarOptions& lidar) {
  read_sensor(section, lidar.sensor);
  read(section, "bias_deg", kTilt, lidar.bias_deg);
  read(section, "noise_mm", kNoise, lidar.noise_mm);
  read(section, "range_bias_mm", kPlace, lidar.range_bias_mm);
  read(section, "near_bias_mm", kPlace, lidar.near_bias_mm);
  read(section, "dropout_rate", kRate, lidar.dropout_rate);
  read(section, "spot_radius_mm", kNoise, lidar.spot_radius_mm);
  read(section, "divergence_mrad", kNoise, lidar.divergence_mrad);
  read(section, "echo_fraction", kRate, lidar.echo_fraction);
  read(section, "echo_jitter", kRate, lidar.echo_jitter);
  read(section, "gain_knee_mm", kSize, lidar.gain_knee_mm);
  read(section, "echo_merge_mm", kSize, lidar.echo_merge_mm);
  read(section, "mixed_pixel_rate", kRate, lidar.mixed_pixel_rate);
}

void read_timing(YamlSection& section, sim::LidarTimingOptions& timing) {
  read(section, "scan_period_ms", {5.0, 1000.0}, timing.scan_period_ms);
  read(section, "clock_gain_ppm", kPpm, timing.clock_gain_ppm);
  read(section, "stamp_start_ms", {0.0, 16777215.0}, timing.stamp_start_ms);
  if (section.has("stamp_origin")) {
    timing.stamp_at_rear_centre =
        section.one_of("stamp_origin", {"first_beam", "rear_centre"}) == "rear_centre";
  }
  read(section, "start_latency_ms", kTime, timing.start_latency_ms);
  read(section, "send_delay_ms", kTime, timing.send_delay_ms);
  read(section, "send_jitter_ms", kTime, timing.send_jitter_ms);
}

void read_encoder(YamlSection& section, sim::EncoderOptions& encoder) {
  encoder.present = true;
  read(section, "step_deg", {1e-6, 10.0}, encoder.step_deg);
  read(section, "latency_min_ms", kTime, encoder.latency_min_ms);
  read(section, "latency_max_ms", kTime, encoder.latency_max_ms);
  if (encoder.latency_max_ms < encoder.latency_min_ms) {
    section.refuse("latency_max_ms", "must not be below latency_min_ms");
  }
}

void read_motor(YamlSection& section, sim::MotorOptions& motor) {
  read(section, "steps_per_turn", {1.0, 1e8}, motor.shaft.steps_per_turn);
  read(section, "power_up_angle_deg", kAnyAngle_deg, motor.shaft.power_up_angle_deg);
  read(section, "ripple_deg", kTilt, motor.shaft.ripple_deg);
  read(section, "ripple_period_deg", {0.001, 360.0}, motor.shaft.ripple_period_deg);
  read(section, "home_angle_deg", kAnyAngle_deg, motor.home_angle_deg);
  read(section, "home_sigma_deg", {0.0, 45.0}, motor.home_sigma_deg);
  read(section, "home_time_s", {0.01, 60.0}, motor.home_time_s);
  read(section, "switch_works", motor.switch_works);
  read(section, "start_latency_min_ms", kTime, motor.start_latency_min_ms);
  read(section, "start_latency_max_ms", kTime, motor.start_latency_max_ms);
  read(section, "crystal_ppm", kPpm, motor.crystal_ppm);
  read(section, "boot_s", {0.0, 60.0}, motor.boot_s);
  read(section, "lose_every", kCount, motor.lose_every);
  read(section, "lose_after_s", kTime, motor.lose_after_s);
  read(section, "travel_deg", {1.0, 1e6}, motor.travel_deg);
  in_section(section, "encoder",
             [&](YamlSection& encoder) { read_encoder(encoder, motor.encoder); });
  if (motor.start_latency_max_ms < motor.start_latency_min_ms) {
    section.refuse("start_latency_max_ms", "must not be below start_latency_min_ms");
  }
}

void read_server(YamlSection& section, sim::ScipServerOptions& server) {
  read(section, "port", {0.0, 65535.0}, server.port);
  read(section, "reboot_s", {0.0, 60.0}, server.reboot_s);
  read(section, "chop", server.misbehaviour.chop);
  read(section, "glue_frames", {0.0, 100.0}, server.misbehaviour.glue_frames);
  read(section, "stall_every", kCount, server.misbehaviour.stall_every);
  read(section, "stall_s", kTime, server.misbehaviour.stall_s);
  read(section, "bad_sum_every", kCount, server.misbehaviour.bad_sum_every);
  read(section, "close_every", kCount, server.misbehaviour.close_every);
}

}  // namespace

sim::BenchOptions load_bench_file(const std::string& path) {
  YamlSection file = YamlSection::load(path);
  sim::BenchOptions options;
  options.seed = static_cast<std::uint64_t>(file.integer("seed", kCount, 1));
  const auto section = [&](const char* key, auto&& read_section, auto& target) {
    in_section(file, key, [&](YamlSection& found) { read_section(found, target); });
  };
  section("room", read_room, options.world.room);
  section("plate", read_plate_of_bench, options.world.plate);
  section("ring_clutter", read_clutter, options.world.ring_clutter);
  section("axis", read_placement, options.lidar.axis);
  section("mounting", read_placement, options.lidar.mounting);
  section("lidar", read_lidar_of_bench, options.lidar);
  section("timing", read_timing, options.timing);
  section("stepper", read_motor, options.motor);
  section("server", read_server, options.server);
  file.finish();
  return options;
}

}  // namespace swivel
