#include "components/swivel/report/mounting_evaluator.hpp"

#include <utility>

#include "components/swivel/offline/mounting_json.hpp"

namespace swivel {

MountingEvaluator::MountingEvaluator(std::string folder, std::string title,
                                     const RigGeometry& nominal)
    : nominal_(nominal), pictures_(std::move(folder), std::move(title), nominal) {}

nlohmann::ordered_json MountingEvaluator::add(const ProcessedSweep& processed) {
  nlohmann::ordered_json json;
  if (processed.readings.lines.empty()) return json;
  const MountingResult result = fit_mounting(processed.readings, nominal_);
  if (!result.fit) {
    json["mounting"] = {{"refused", result.reason}};
    return json;
  }
  json["mounting"] = mounting_json({processed.index}, *result.fit);
  const auto roof_m = pictures_.add(processed.index, processed.readings, *result.fit);
  if (roof_m) json["mounting"]["roof_mean_deviation_mm"] = roof_json(*roof_m);
  return json;
}

std::vector<Figure> MountingEvaluator::figures(const std::optional<AttitudeTruth>& truth) const {
  Figure steps{
      "The roof under each step of a calibration (Zeng 2018, fig. 10)",
      "How far the rays to the roof, or to the floor, come to lie off their plane: with the "
      "mounting of the rig file, with what the half scans say of it where the bias is not "
      "asked, with the bias alone, and with both found from this sweep. The flatter, the "
      "better; blue and vermillion apart is a mounting that is wrong.",
      {}};
  Figure deviations{"How dense these deviations lie (fig. 11)",
                    "Left the first half of the turn, right the half that follows. The blue curves "
                    "should be as narrow as the lidar's noise, and alike.",
                    {}};
  for (const MountingPictures::Roof& roof : pictures_.roofs()) {
    const std::string label = "sweep " + std::to_string(roof.sweep);
    steps.pictures.push_back({roof.steps_path, label});
    deviations.pictures.push_back({roof.deviations_path, label});
  }
  Figure biases{"The bias that each sweep shows (fig. 7)",
                "Orange: by the paper's algorithm 1. Blue: jointly with the mounting. Below, where "
                "the truth is known, how far off they are; two of three bars should reach the line "
                "at 0.",
                {}};
  const std::string path = pictures_.draw_biases(
      [&](std::size_t sweep) { return truth ? truth->bias_deg(sweep) : std::nullopt; });
  if (!path.empty()) biases.pictures.push_back({path, ""});
  return {std::move(steps), std::move(deviations), std::move(biases)};
}

}  // namespace swivel
