#include "components/swivel/offline/mounting_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "calibration/roof_steps.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/pictures/mounting_charts.hpp"

namespace swivel {
MountingPictures::MountingPictures(std::string folder, std::string title,
                                   const RigGeometry& nominal)
    : folder_(std::move(folder)), title_(std::move(title)), nominal_(nominal) {}

std::optional<std::vector<double>> MountingPictures::add(std::size_t sweep,
                                                         const SweepReadings& readings,
                                                         const MountingFit& fit) {
  if (is_seen(fit.solution, kMountingBias)) {
    biases_.push_back({sweep, fit.symmetric_rays, fit.solution.value[kMountingBias],
                       fit.sigma_of(kMountingBias)});
  }
  const auto look = look_at_roof(readings, nominal_, fit);
  if (!look) return std::nullopt;
  Roof roof{sweep, fmt::format("{}/roof_{:02}.png", folder_, sweep),
            fmt::format("{}/roof_deviations_{:02}.png", folder_, sweep)};
  const std::string title = fmt::format("{}: roof, sweep {}", title_, sweep);
  require_written(write_roof_chart(roof.steps_path, title, *look));
  require_written(write_deviations_chart(roof.deviations_path, title, *look));
  roofs_.push_back(std::move(roof));
  std::vector<double> means_m(kRoofSteps);
  std::transform(look->off_m.begin(), look->off_m.end(), means_m.begin(), mean_deviation_m);
  return means_m;
}

std::string MountingPictures::draw_biases(const TrueBias& true_bias_deg) const {
  std::vector<FoundBias> found;
  bool judged = false;
  for (const Bias& bias : biases_) {
    const auto truth_deg = true_bias_deg ? true_bias_deg(bias.sweep) : std::nullopt;
    judged = judged || truth_deg;
    found.push_back({bias.sweep, deg_from_rad(bias.symmetric_rays.bias_rad),
                     deg_from_rad(bias.symmetric_rays.sigma_rad), deg_from_rad(bias.joint_rad),
                     deg_from_rad(bias.joint_sigma_rad), truth_deg.value_or(kUnknownAngle)});
  }
  if (found.empty() || (found.size() < 2 && !judged)) return {};
  const std::string path = folder_ + "/bias.png";
  require_written(write_bias_chart(path, title_ + ": bias of the centreline", found));
  return path;
}

}  // namespace swivel
