#include "tests/calibration/simulated_sweep.hpp"

#include <array>

#include "calibration/line_assembly.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr std::array<std::size_t, 7> kLinesOfMode{40, 80, 160, 200, 320, 400, 640};
constexpr double kLineS = 0.025;
constexpr double kBeamsPerTurn = 1440.0;

}  // namespace

OrganisedCloud raw_cloud(const SimulatedSweep& sweep) {
  const std::size_t lines = kLinesOfMode.at(static_cast<std::size_t>(sweep.mode - 1));
  const double line_rad = kPi / static_cast<double>(lines);
  const double loss_s = sweep.at_share * kLineS * static_cast<double>(lines);
  const auto shaft_rad = [&](std::int64_t time_ns) {
    const double time_s = s_from_ns(static_cast<double>(time_ns));
    const double further_deg = time_s > loss_s ? sweep.further_deg : 0.0;
    return rad_from_deg(sweep.start_deg + further_deg) + time_s / kLineS * line_rad;
  };
  const sim::World world(sweep.world);
  const sim::Lidar lidar(sweep.lidar, world, sweep.seed);
  LineAssembler assembler(
      ForwardModel(yuans_rig(), rad_from_deg(-135.0), rad_from_deg(0.25), 1081));
  OrganisedCloud cloud(lines, 1081);
  for (std::size_t line = 0; line < lines; ++line) {
    if (4 * line > lines + 4 && 4 * line + 8 < 3 * lines) continue;
    const auto time_ns = static_cast<std::int64_t>(ns_from_s(kLineS) * static_cast<double>(line));
    const auto reading =
        lidar.cast_line({line, time_ns, ns_from_s(kLineS) / kBeamsPerTurn}, shaft_rad);
    assembler.assemble({reading.ranges_mm, reading.intensities, 20, 30'000},
                       static_cast<double>(line) * line_rad, line_rad / kBeamsPerTurn,
                       cloud.line(line));
  }
  return cloud;
}

}  // namespace swivel
