#include "components/swivel/report/sweep_evaluator.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/attitude_corrector/corrector.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/pictures/attitude_charts.hpp"
#include "components/swivel/report/evaluation_json.hpp"

namespace swivel {
namespace {

void must_be_written(const Outcome& outcome) {
  if (!outcome) throw ExitError(kExitInputOutput, outcome.reason());
}

SweepFacts facts_of(const ProcessedSweep& processed, const std::vector<Surface>& surfaces) {
  const msg::Attitude& attitude = processed.attitude;
  SweepFacts facts;
  facts.attitude.sweep = processed.index;
  facts.attitude.mode = processed.sweep.mode();
  facts.attitude.corrected = attitude.verdict() == msg::VERDICT_GOOD;
  if (facts.attitude.corrected) {
    facts.attitude.phi_offset_rad =
        std::remainder(rad_from_deg(attitude.phi_offset_deg()), 2 * kPi);
    facts.attitude.sigma_rad = rad_from_deg(attitude.phi_offset_sigma_deg());
  }
  facts.verdict = verdict_word(attitude.verdict());
  facts.reason = attitude.reason().empty() ? processed.sweep.reason() : attitude.reason();
  facts.warning = attitude.warning();
  facts.lines_missing = processed.sweep.lines_missing();
  facts.seam_deg = attitude.seam_deg();
  facts.seam_sigma_deg = attitude.seam_sigma_deg();
  for (const Surface& surface : surfaces) {
    if (surface.share_within >= facts.worst_share_within_40_mm) continue;
    facts.worst_share_within_40_mm = surface.share_within;
    facts.worst_surface = surface.name;
  }
  return facts;
}

std::vector<Plane> planes_of(const std::vector<Surface>& surfaces) {
  std::vector<Plane> planes;
  planes.reserve(surfaces.size());
  for (const Surface& surface : surfaces) planes.push_back(surface.plane);
  return planes;
}

}  // namespace

SweepEvaluator::SweepEvaluator(std::string folder, std::string title, const RigFile& rig,
                               double room_yaw_deg)
    : folder_(std::move(folder)),
      title_(std::move(title)),
      rig_(rig),
      pictures_(folder_, title_, rig_),
      room_yaw_rad_(rad_from_deg(room_yaw_deg)),
      mounting_(folder_, title_, rig.geometry) {
  evaluation_.axis_measured = rig.axis_measured;
}

nlohmann::ordered_json SweepEvaluator::add(const ProcessedSweep& processed) {
  const std::vector<Surface> surfaces = pictures_.surfaces_of(processed);
  evaluation_.sweeps.push_back(facts_of(processed, surfaces));
  evaluation_.naive = evaluation_.naive || processed.sweep.action_sequence() == msg::SEQUENCE_NAIVE;
  evaluation_.alpha_calibrated = processed.attitude.calibrated();
  if (!rig_.axis_measured) evaluation_.alpha_deg = processed.attitude.alpha_deg();
  walls_.push_back(planes_of(surfaces));
  device_stamps_ms_.push_back(processed.sweep.first_device_stamp_ms());
  if (!processed.cloud.points.empty()) pictures_.draw(processed, surfaces);
  nlohmann::ordered_json json = mounting_.add(processed);
  json["surfaces"] = surfaces_json(surfaces);
  return json;
}

void SweepEvaluator::judge_errors(const std::optional<AttitudeTruth>& truth) {
  if (rig_.axis_measured) return;
  std::vector<SweepAttitude> attitudes = evaluation_.attitudes();
  bool known = false;
  const bool by_start = truth && !evaluation_.naive;
  for (std::size_t place = 0; by_start && place < attitudes.size(); ++place) {
    const auto start_deg = truth->phi_start_deg(attitudes[place].sweep, device_stamps_ms_[place]);
    if (start_deg) judge_by_start(rad_from_deg(*start_deg), attitudes[place]);
    known = known || start_deg;
  }
  if (known) evaluation_.true_alpha_deg = truth->alpha_deg().value_or(kUnknownAngle);
  evaluation_.reference =
      known ? Reference::kTruth : judge_by_walls(walls_, room_yaw_rad_, attitudes);
  for (std::size_t place = 0; place < attitudes.size(); ++place)
    evaluation_.sweeps[place].attitude = attitudes[place];
}

// Of each mode the sweep with the largest error, and the first of each verdict that is not good.
std::vector<const SweepFacts*> SweepEvaluator::sweeps_to_show() const {
  std::map<int, const SweepFacts*> worst;
  std::map<std::string, const SweepFacts*> refused;
  for (const SweepFacts& sweep : evaluation_.sweeps) {
    if (!sweep.attitude.corrected && !rig_.axis_measured) {
      refused.emplace(sweep.verdict, &sweep);
      continue;
    }
    const SweepFacts*& of_mode = worst[sweep.attitude.mode];
    if (of_mode == nullptr ||
        std::abs(sweep.attitude.with_rad) > std::abs(of_mode->attitude.with_rad))
      of_mode = &sweep;
  }
  std::vector<const SweepFacts*> shown;
  shown.reserve(worst.size() + refused.size());
  for (const auto& [mode, sweep] : worst) shown.push_back(sweep);
  for (const auto& [verdict, sweep] : refused) shown.push_back(sweep);
  return shown;
}

std::vector<Figure> SweepEvaluator::figures_of_all() const {
  if (evaluation_.axis_measured || evaluation_.reference == Reference::kNone) return {};
  const auto attitudes = evaluation_.attitudes();
  const auto modes = by_mode(attitudes);
  const auto path = [&](const char* name) { return folder_ + "/" + name; };
  must_be_written(write_sweeps_chart(path("phi_error_sweeps.png"), title_, attitudes));
  must_be_written(write_modes_chart(path("phi_error_modes.png"), title_, modes));
  must_be_written(write_map_error_chart(path("map_error.png"), title_, modes));
  return {
      {"phi_error of every sweep (fig. 9 of the paper)",
       "Vermillion: the cloud as it comes, its sweep taken to begin at 0 deg. Blue: corrected by "
       "the plate. The nearer to 0, the better; below, the corrected ones alone, on their own "
       "scale. Two of three bars, one sigma long either way, should reach the line at 0.",
       {{path("phi_error_sweeps.png"), ""}}},
      {"phi_error of every mode (fig. 10)",
       "From the least to the largest error of each mode, the ring at their mean. A short blue "
       "bar off 0 is an error that all its sweeps share, as that of alpha.",
       {{path("phi_error_modes.png"), ""}}},
      {"Map error over distance (fig. 11)",
       "How far a point is off its place on the map, by its distance from the scanner. A blue "
       "wedge that stays in the grey band up to 10 m keeps +-50 mm wherever the lidar reaches.",
       {{path("map_error.png"), ""}}}};
}

std::string SweepEvaluator::label_of(const SweepFacts& sweep) const {
  std::string label = fmt::format("sweep {}", sweep.attitude.sweep);
  if (sweep.attitude.mode != 0) label += fmt::format(", mode {}", sweep.attitude.mode);
  if (rig_.axis_measured || sweep.attitude.corrected) return label;
  return label + ", not corrected: " + sweep.verdict;
}

std::vector<Figure> SweepEvaluator::figures_of_sweeps() const {
  const std::vector<const SweepFacts*> shown = sweeps_to_show();
  const auto pictures = [&](const char* kind) {
    std::vector<Picture> found;
    for (const SweepFacts* sweep : shown) {
      const std::string path = pictures_.path(kind, sweep->attitude.sweep);
      if (pictures_.is_drawn(path)) found.push_back({path, label_of(*sweep)});
    }
    return found;
  };
  return {
      {"Seen from above (fig. 8)",
       rig_.axis_measured ? "The cloud in the rig's base."
                          : "Vermillion: as it came; blue: corrected. If the rig stood square in "
                            "a square room, the blue walls lie along the grid. Of each mode the "
                            "sweep with the largest error is shown, here and below, and the "
                            "first of each verdict other than good.",
       pictures("top_view")},
      {"Points off their fitted planes (fig. A2)",
       "Left and middle: how far points lie off the plane, along it and up it; the black means "
       "should be straight and level. Right: their histogram; it should be as narrow as the "
       "lidar's noise and look like the curve.",
       pictures("surfaces")},
      {"The seam",
       "Where the first lines (blue) and the last (vermillion) see the same wall, one to the left "
       "and one to the right of the seam. Right: their distance from that wall, drawn so that the "
       "first lines lie level. If the seam is closed the last go on level; if it is open by 1 deg "
       "they follow a dashed line.",
       pictures("seam")},
      {"The plate",
       "Every dot is a beam followed down to the plate's plane: blue if it measured a point "
       "there, orange if it measured elsewhere, since it went past or by its noise. The blue ones "
       "should fill the triangle, with few outside of it.",
       pictures("plate")}};
}

PageHead SweepEvaluator::page_head() const {
  PageHead head;
  head.title = "Swivel: " + title_;
  head.facts = {{"sweeps", std::to_string(evaluation_.sweeps.size())},
                {"rig", rig_.path},
                {"version", SWIVEL_VERSION}};
  if (rig_.axis_measured) return head;
  head.facts.emplace_back("estimator", rig_.estimator);
  head.facts.emplace_back(
      "alpha", std::isnan(evaluation_.alpha_deg)
                   ? "not known"
                   : fmt::format("{:.4f} deg, {}", evaluation_.alpha_deg,
                                 evaluation_.alpha_calibrated ? "calibrated" : "as drawn"));
  return head;
}

void SweepEvaluator::finish(const std::optional<AttitudeTruth>& truth, OutputFolder& output) {
  judge_errors(truth);
  output.note("evaluation", evaluation_json(evaluation_));
  std::vector<Figure> figures = figures_of_all();
  for (Figure& figure : mounting_.figures(truth)) figures.push_back(std::move(figure));
  for (Figure& figure : figures_of_sweeps()) figures.push_back(std::move(figure));
  write_text_file(folder_ + "/report.html", report_page(page_head(), evaluation_, figures));
}

}  // namespace swivel
