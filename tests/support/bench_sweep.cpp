#include "tests/support/bench_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/line_assembly.hpp"
#include "hardware/sim/random.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr std::array<std::size_t, 7> kLinesOfMode{40, 80, 160, 200, 320, 400, 640};
constexpr double kNominalPeriod_ms = 25.0;  // half a turn is told in lines of this
constexpr int kLastPlateStep = 139;         // the plate ends at 64; those beyond tell the misses
constexpr std::uint64_t kDrawnStream = 0xD4A3;

ForwardModel model_of(const sim::LidarOptions& lidar) {
  RigGeometry rig = yuans_rig();
  rig.T_axis_lidar.translation().x() = m_from_mm(lidar.mounting.xyz_mm.x);
  const double step_rad = 2.0 * kPi / lidar.sensor.steps_per_turn;
  return {rig, -lidar.sensor.front_step * step_rad, step_rad,
          static_cast<std::size_t>(lidar.sensor.last_step) + 1};
}

// The commanded turn and the true one, from the instant of the first beam.
double truly_turned_deg(const LostSteps& lost, double turned_deg) {
  const double beyond_deg = std::max(0.0, turned_deg - lost.after_turn_deg);
  return turned_deg - std::min(beyond_deg, lost.angle_deg);
}

}  // namespace

const char* name_of(Tier tier) {
  switch (tier) {
    case Tier::kClean:
      return "clean";
    case Tier::kReal:
      return "real";
    case Tier::kRough:
      return "rough";
  }
  return "";
}

BenchSweepOptions at_tier(Tier tier, BenchSweepOptions options) {
  sim::LidarOptions& lidar = options.lidar;
  lidar.noise_mm = 13.0;
  lidar.dropout_rate = 0.0;
  lidar.spot_radius_mm = 0.0;
  if (tier == Tier::kClean) return options;
  lidar.dropout_rate = 0.005;
  lidar.spot_radius_mm = 4.0;
  lidar.divergence_mrad = 6.0;
  lidar.echo_jitter = 0.2;
  lidar.mixed_pixel_rate = 0.0;  // only surfaces that are near to one another blend
  if (tier == Tier::kReal) return options;
  lidar.noise_mm = 20.0;
  lidar.dropout_rate = 0.02;
  lidar.range_bias_mm = 3.0;
  lidar.spot_radius_mm = 8.0;
  lidar.mixed_pixel_rate = 0.3;
  options.world.plate.pitch_deg = 1.5;
  options.world.plate.roll_deg = -1.0;
  options.world.plate.depth_mm += 1.0;
  return options;
}

sim::RoomOptions room_of(Room room) {
  sim::RoomOptions options;
  if (room != Room::kCluttered) options.furniture.clear();
  if (room == Room::kSkewed) options.front_skew_deg = 0.5;
  return options;
}

BenchSweepOptions drawn_sweep(Tier tier, int mode, std::uint64_t seed) {
  sim::Random random(seed, kDrawnStream);
  BenchSweepOptions options;
  options.mode = mode;
  options.seed = seed;
  options.phi_start_deg = random.uniform(-3.0, 3.0);
  options.world.plate.alpha_deg = random.uniform(29.0, 31.0);
  return at_tier(tier, options);
}

BenchSweep make_bench_sweep(const BenchSweepOptions& options) {
  const std::size_t lines = kLinesOfMode.at(static_cast<std::size_t>(options.mode) - 1);
  sim::LidarOptions optics = options.lidar;
  if (options.plate_beams_only) optics.sensor.last_step = kLastPlateStep;
  const double speed_deg_ms = 180.0 / (static_cast<double>(lines) * kNominalPeriod_ms);
  const double beam_period_ns = options.scan_period_ms * 1e6 / optics.sensor.steps_per_turn;
  const double angle_per_line_rad = rad_from_deg(speed_deg_ms * options.scan_period_ms);

  const sim::World world(options.world);
  const sim::Lidar lidar(optics, world, options.seed);
  const auto shaft_angle = [&](std::int64_t time_ns) {
    const double turned_deg = speed_deg_ms * static_cast<double>(time_ns) * 1e-6;
    return rad_from_deg(options.phi_start_deg + truly_turned_deg(options.lost, turned_deg));
  };
  LineAssembler assembler(model_of(optics));
  BenchSweep sweep;
  sweep.cloud = OrganisedCloud(lines, assembler.model().beam_count());
  for (std::size_t line = 0; line < lines; ++line) {
    const auto count = static_cast<double>(line);
    const auto beam0_ns = std::llround(count * options.scan_period_ms * 1e6);
    const auto cast = lidar.cast_line({line, beam0_ns, beam_period_ns}, shaft_angle);
    assembler.assemble({cast.ranges_mm, cast.intensities, 20, 30000}, count * angle_per_line_rad,
                       angle_per_line_rad / optics.sensor.steps_per_turn, sweep.cloud.line(line));
  }
  sweep.phi_start_rad = rad_from_deg(options.phi_start_deg);
  sweep.alpha_rad = rad_from_deg(options.world.plate.alpha_deg);
  sweep.beta_rad = sweep.alpha_rad - sweep.phi_start_rad;
  sweep.angle_per_line_rad = angle_per_line_rad;
  return sweep;
}

}  // namespace swivel
