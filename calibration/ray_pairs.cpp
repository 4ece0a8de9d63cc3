#include "calibration/ray_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr double kLeastRayRad = rad_from_deg(3.0);  // from the axis: nearer ones tell nothing
constexpr double kMostRayRad = rad_from_deg(45.0);  // further ones meet corners and walls
constexpr double kHeightStepM = 0.05;
constexpr double kHeightBandM = 0.15;  // about the commonest height, as a bias of 5 deg bends it
constexpr double kLeastShareOfPairs = 0.05;  // at one height, to be a roof or a floor

}  // namespace

RayPairs pairs_of(const SweepReadings& readings, double centreline_rad) {
  RayPairs pairs;
  const double first_rad = readings.first_beam_angle_rad + centreline_rad;
  const double step_rad = readings.beam_step_rad;
  const auto beams = static_cast<double>(readings.beams());
  const auto looks_up_or_down = [](double angle_rad) {
    const double off_rad = std::abs(std::remainder(angle_rad, kPi));
    return off_rad > kLeastRayRad && off_rad < kMostRayRad;
  };
  for (std::size_t beam = 0; beam < readings.beams(); ++beam) {
    const double angle_rad = first_rad + static_cast<double>(beam) * step_rad;
    const double opposite = std::round((-angle_rad - first_rad) / step_rad);
    if (angle_rad <= 0.0 || opposite < 0.0 || opposite >= beams) continue;
    if (!looks_up_or_down(angle_rad)) continue;
    const auto other = static_cast<std::size_t>(opposite);
    for (std::size_t line = 0; line < readings.lines.size(); ++line) {
      const LineOfReadings& said = readings.lines[line];
      const auto first_m = static_cast<double>(said.ranges_m[beam]);
      const auto second_m = static_cast<double>(said.ranges_m[other]);
      if (std::isnan(first_m) || std::isnan(second_m)) continue;
      const double axis_rad =
          said.axis_angle_rad + 0.5 * static_cast<double>(beam + other) * said.angle_per_beam_rad;
      pairs.push_back(
          {line, axis_rad, angle_rad, first_rad + opposite * step_rad, first_m, second_m});
    }
  }
  return pairs;
}

RayPairs on_roof_or_floor(const RayPairs& pairs) {
  std::map<long, std::size_t> counts;
  for (const RayPair& pair : pairs) ++counts[std::lround(pair.height_m() / kHeightStepM)];
  RayPairs kept;
  for (const bool above : {true, false}) {
    long commonest = 0;
    std::size_t most = 0;
    for (const auto& [height, count] : counts) {
      if ((height > 0) != above || count <= most) continue;
      most = count;
      commonest = height;
    }
    if (static_cast<double>(most) < kLeastShareOfPairs * static_cast<double>(pairs.size()))
      continue;
    const double height_m = static_cast<double>(commonest) * kHeightStepM;
    const auto near = [&](const RayPair& pair) {
      return std::abs(pair.height_m() - height_m) < kHeightBandM;
    };
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(kept), near);
  }
  return kept;
}

}  // namespace swivel
