#include "components/swivel/report/evaluation_json.hpp"

#include "calibration/units.hpp"

namespace swivel {
namespace {

using Json = nlohmann::ordered_json;

// A NaN becomes null.
Json statistics_json(const AngleStatistics& errors) {
  return {{"sweeps", errors.count},
          {"mean_deg", deg_from_rad(errors.mean_rad)},
          {"rms_deg", deg_from_rad(errors.rms_rad)},
          {"least_deg", deg_from_rad(errors.lowest_rad)},
          {"largest_deg", deg_from_rad(errors.highest_rad)},
          {"largest_magnitude_deg",
           deg_from_rad(errors.count == 0 ? kUnknownAngle : errors.largest_rad())}};
}

// Eq. Y21 of the largest error, metre by metre.
Json map_error_json(const AngleStatistics& errors) {
  auto errors_mm = Json::array();
  if (errors.count == 0) return errors_mm;
  for (int metre = 0; metre <= static_cast<int>(kMapReach_m); ++metre)
    errors_mm.push_back(mm_from_m(map_error_m(metre, errors.largest_rad())));
  return errors_mm;
}

Json mode_json(const ModeEvaluation& mode) {
  const double kept_m =
      mode.with.count == 0 ? kUnknownAngle : kept_up_to_m(mode.with.largest_rad());
  return {{"mode", mode.mode},
          {"sweeps", mode.sweeps},
          {"phi_error_without_correction", statistics_json(mode.without)},
          {"phi_error_with_correction", statistics_json(mode.with)},
          {"map_error_within_50_mm_up_to_m", kept_m},
          {"map_error_mm_at_0_to_10_m", map_error_json(mode.with)}};
}

Json sweep_errors_json(const SweepAttitude& attitude) {
  return {{"sweep", attitude.sweep},
          {"mode", attitude.mode},
          {"corrected", attitude.corrected},
          {"phi_error_without_correction_deg", deg_from_rad(attitude.without_rad)},
          {"phi_error_with_correction_deg", deg_from_rad(attitude.with_rad)},
          {"phi_offset_sigma_deg", deg_from_rad(attitude.sigma_rad)}};
}

const char* kind_word(Finding::Kind kind) {
  if (kind == Finding::Kind::kGood) return "good";
  return kind == Finding::Kind::kBad ? "not_good" : "note";
}

}  // namespace

Json evaluation_json(const Evaluation& evaluation) {
  Json json;
  json["sign_of_phi_error"] =
      "positive where the cloud lies clockwise of where it should, seen from above";
  json["phi_error_is_against"] = in_words(evaluation.reference);
  json["axis_measured"] = evaluation.axis_measured;
  json["alpha_deg"] = evaluation.alpha_deg;
  json["true_alpha_deg"] = evaluation.true_alpha_deg;
  json["verdicts"] = evaluation.verdicts();
  json["findings"] = Json::array();
  for (const Finding& finding : findings_of(evaluation))
    json["findings"].push_back({{"kind", kind_word(finding.kind)}, {"words", finding.words}});
  if (evaluation.axis_measured) return json;
  json["modes"] = Json::array();
  for (const ModeEvaluation& mode : by_mode(evaluation.attitudes()))
    json["modes"].push_back(mode_json(mode));
  json["sweeps"] = Json::array();
  for (const SweepAttitude& attitude : evaluation.attitudes())
    json["sweeps"].push_back(sweep_errors_json(attitude));
  return json;
}

Json surfaces_json(const std::vector<Surface>& surfaces) {
  auto json = Json::array();
  for (const Surface& surface : surfaces) {
    const Eigen::Vector3d& normal = surface.plane.normal;
    json.push_back({{"name", surface.name},
                    {"normal", {normal.x(), normal.y(), normal.z()}},
                    {"normal_azimuth_deg", deg_from_rad(surface.plane.azimuth_rad())},
                    {"normal_azimuth_sigma_deg", deg_from_rad(surface.plane.azimuth_sigma_rad)},
                    {"distance_m", surface.plane.distance_m},
                    {"points_within_100_mm", surface.points.size()},
                    {"sd_mm", mm_from_m(surface.sd_m)},
                    {"within_40_mm_percent", 100.0 * surface.share_within}});
  }
  return json;
}

}  // namespace swivel
