#include "components/swivel_bench/bench_options.hpp"

#include "components/common/program.hpp"
#include "components/swivel_bench/bench_file.hpp"

namespace swivel {

using sim::BenchOptions;

namespace {

std::string bench_file_of(const std::string& rig) {
  return shared_file("benches/" + rig + ".yaml");
}

}  // namespace

BenchCommandLine::BenchCommandLine(CLI::App& app) : file_(bench_file_of("yuan")) {
  add_files(app);
  add_world(app);
  add_lidar(app);
  add_motor(app);
  add_misbehaviour(app);
}

sim::BenchOptions BenchCommandLine::options() const {
  BenchOptions bench = load_bench_file(file_);
  for (const Change& change : changes_) change(bench);
  return bench;
}

void BenchCommandLine::flag(CLI::App& app, const std::string& name, const std::string& help,
                            const Change& change) {
  app.add_flag_callback(
      name, [this, change] { changes_.push_back(change); }, help);
}

void BenchCommandLine::add_files(CLI::App& app) {
  CLI::Option* const file =
      app.add_option("--config", file_, "The bench's world")->capture_default_str();
  app.add_option_function<std::string>(
         "--rig", [this](const std::string& rig) { file_ = bench_file_of(rig); },
         "The world of a shipped rig: yuan, zeng or tilting")
      ->excludes(file)
      ->check(CLI::IsMember({"yuan", "zeng", "tilting"}));
  app.add_option("--log-level", log_level_, "What to log")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();
  app.add_option("--replay-capture", capture_,
                 "Instead of a world, say again what a lidar and a stepper said: a file of swivel "
                 "capture");
  option<std::string>(app, "--stepper-link", "Make this symbolic link to the stepper's pty",
                      [](BenchOptions& b, const std::string& v) { b.stepper_link = v; });
  option<std::string>(app, "--truth", "Write what really happened to this CSV file",
                      [](BenchOptions& b, const std::string& v) { b.truth_path = v; });
  option<std::string>(app, "--control", "Make this Unix socket, which takes faults and questions",
                      [](BenchOptions& b, const std::string& v) { b.control_path = v; });
  option<std::uint64_t>(app, "--seed", "Of all random numbers",
                        [](BenchOptions& b, std::uint64_t v) { b.seed = v; });
  option<int>(app, "--port", "Of the lidar, on 127.0.0.1; 0 for any free one",
              [](BenchOptions& b, int v) { b.server.port = v; })
      ->check(CLI::Range(0, 65535));
}

void BenchCommandLine::add_lidar(CLI::App& app) {
  option<double>(app, "--noise-mm", "Standard deviation of a range", [](BenchOptions& b, double v) {
    b.lidar.noise_mm = v;
  })->check(CLI::Range(0.0, 1000.0));
  option<double>(app, "--dropout-rate", "Of echoes lost", [](BenchOptions& b, double v) {
    b.lidar.dropout_rate = v;
  })->check(CLI::Range(0.0, 1.0));
  option<double>(app, "--bias-deg", "Of the centreline: added to every beam's angle",
                 [](BenchOptions& b, double v) { b.lidar.bias_deg = v; })
      ->check(CLI::Range(-45.0, 45.0));
  add_triple(app, "--mounting-xyz-mm", "X,Y,Z: how far the lidar is off its place on the axis",
             &sim::Placement::xyz_mm);
  add_triple(app, "--mounting-rpy-deg", "ROLL,PITCH,YAW: added to those of the mounting",
             &sim::Placement::rpy_deg);
  option<std::string>(
      app, "--serial-number", "Of the lidar",
      [](BenchOptions& b, const std::string& v) { b.lidar.sensor.serial_number = v; });
}

void BenchCommandLine::add_triple(CLI::App& app, const std::string& name, const std::string& help,
                                  sim::Vector3 sim::Placement::*part) {
  option<std::vector<double>>(app, name, help,
                              [part](BenchOptions& b, const std::vector<double>& v) {
                                sim::Vector3& value = b.lidar.mounting.*part;
                                value = value + sim::Vector3{v[0], v[1], v[2]};
                              })
      ->delimiter(',')
      ->expected(3);
}

void BenchCommandLine::add_world(CLI::App& app) {
  option<double>(app, "--alpha-deg", "Azimuth of the plate", [](BenchOptions& b, double v) {
    b.world.plate.alpha_deg = v;
  })->check(CLI::Range(-360.0, 360.0));
  option<double>(app, "--room-yaw-deg", "Of the room against the rig's front",
                 [](BenchOptions& b, double v) { b.world.room.yaw_deg = v; })
      ->check(CLI::Range(-360.0, 360.0));
  option<double>(app, "--scan-period-ms", "The lidar's true one", [](BenchOptions& b, double v) {
    b.timing.scan_period_ms = v;
  })->check(CLI::Range(5.0, 1000.0));
  option<double>(app, "--stamp-start-ms", "The lidar's counter at the start; it wraps at 2^24",
                 [](BenchOptions& b, double v) { b.timing.stamp_start_ms = v; })
      ->check(CLI::Range(0.0, 16777215.0));
  flag(app, "--no-plate", "Leave the plate out",
       [](BenchOptions& b) { b.world.plate.present = false; });
  flag(app, "--ring-clutter", "Leave something lying in the plate's ring",
       [](BenchOptions& b) { b.world.ring_clutter.present = true; });
}

void BenchCommandLine::add_motor(CLI::App& app) {
  option<double>(app, "--home-time-s", "How long homing takes", [](BenchOptions& b, double v) {
    b.motor.home_time_s = v;
  })->check(CLI::Range(0.01, 60.0));
  option<double>(app, "--home-sigma-deg", "Of the home switch", [](BenchOptions& b, double v) {
    b.motor.home_sigma_deg = v;
  })->check(CLI::Range(0.0, 45.0));
  option<int>(app, "--lose-every", "Each Nth step does not turn the motor",
              [](BenchOptions& b, int v) { b.motor.lose_every = v; })
      ->check(CLI::NonNegativeNumber);
  option<double>(app, "--lose-after-s", "But only from then on", [](BenchOptions& b, double v) {
    b.motor.lose_after_s = v;
  })->check(CLI::NonNegativeNumber);
  flag(app, "--no-switch", "The home switch is never found",
       [](BenchOptions& b) { b.motor.switch_works = false; });
}

void BenchCommandLine::add_misbehaviour(CLI::App& app) {
  flag(app, "--chop", "Send single bytes",
       [](BenchOptions& b) { b.server.misbehaviour.chop = true; });
  option<int>(app, "--glue-frames", "Send this many scans at once", [](BenchOptions& b, int v) {
    b.server.misbehaviour.glue_frames = v;
  })->check(CLI::Range(0, 100));
  option<int>(app, "--stall-every", "After each Nth scan send nothing for a while",
              [](BenchOptions& b, int v) { b.server.misbehaviour.stall_every = v; })
      ->check(CLI::NonNegativeNumber);
  option<double>(app, "--stall-s", "For how long", [](BenchOptions& b, double v) {
    b.server.misbehaviour.stall_s = v;
  })->check(CLI::NonNegativeNumber);
  option<int>(app, "--bad-sum-every", "Spoil each Nth scan", [](BenchOptions& b, int v) {
    b.server.misbehaviour.bad_sum_every = v;
  })->check(CLI::NonNegativeNumber);
  option<int>(app, "--close-every", "Close the connection in the middle of each Nth scan",
              [](BenchOptions& b, int v) { b.server.misbehaviour.close_every = v; })
      ->check(CLI::NonNegativeNumber);
}

}  // namespace swivel
