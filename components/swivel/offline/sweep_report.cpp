#include "components/swivel/offline/sweep_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "calibration/planes.hpp"
#include "components/attitude_corrector/corrector.hpp"

namespace swivel {
namespace {

constexpr std::size_t kPlanes = 4;

std::string number(double value, int decimals) {
  if (std::isnan(value)) return "nan";
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

// Between -180 and 180: a beta near the seam may put it a turn off.
double unwound_deg(double angle_deg) {
  return std::remainder(angle_deg, 360.0);
}

nlohmann::ordered_json planes_json(const OrganisedCloud& cloud) {
  auto planes = nlohmann::ordered_json::array();
  if (cloud.points.empty()) return planes;
  PlaneOptions options;
  options.band_m = 0.02;  // twice the noise: a thicker slab would gather up what is no plane
  for (const Plane& plane : find_planes(cloud, kPlanes, options)) {
    planes.push_back({{"normal", {plane.normal.x(), plane.normal.y(), plane.normal.z()}},
                      {"distance_m", plane.distance_m},
                      {"thickness_sd_mm", mm_from_m(plane.rms_m)},
                      {"points", plane.points}});
  }
  return planes;
}

}  // namespace

std::string attitude_csv_heading() {
  return "sweep,mode,beta_deg,phi_offset_deg,sigma_deg,verdict\n";
}

std::string attitude_csv_row(const ProcessedSweep& processed) {
  const msg::Attitude& attitude = processed.attitude;
  return std::to_string(processed.index) + "," + std::to_string(int{attitude.mode()}) + "," +
         number(attitude.beta_deg(), 6) + "," + number(unwound_deg(attitude.phi_offset_deg()), 6) +
         "," + number(attitude.phi_offset_sigma_deg(), 6) + "," + verdict_word(attitude.verdict()) +
         "\n";
}

nlohmann::ordered_json sweep_json(const ProcessedSweep& processed) {
  const msg::Sweep& sweep = processed.sweep;
  const msg::Attitude& attitude = processed.attitude;
  const auto& points = processed.cloud.points;
  nlohmann::ordered_json json;
  json["sweep"] = processed.index;
  json["mode"] = int{sweep.mode()};
  json["complete"] = sweep.complete();
  json["lines_expected"] = sweep.lines_expected();
  json["lines_missing"] = sweep.lines_missing();
  json["points"] = std::count_if(points.begin(), points.end(),
                                 [](const CloudPoint& point) { return point.valid(); });
  json["verdict"] = verdict_word(attitude.verdict());
  json["reason"] = attitude.reason().empty() ? sweep.reason() : attitude.reason();
  json["corrected"] = Corrector::in_base(attitude.verdict());
  json["beta_deg"] = attitude.beta_deg();
  json["beta_sigma_deg"] = attitude.beta_sigma_deg();
  json["alpha_deg"] = attitude.alpha_deg();
  json["alpha_calibrated"] = attitude.calibrated();
  json["phi_offset_deg"] = unwound_deg(attitude.phi_offset_deg());
  json["phi_offset_sigma_deg"] = attitude.phi_offset_sigma_deg();
  json["plate_points_used"] = attitude.points_used();
  json["plate_residual_mm"] = attitude.residual_mm();
  json["seam_deg"] = attitude.seam_deg();
  json["seam_sigma_deg"] = attitude.seam_sigma_deg();
  json["warning"] = attitude.warning();
  json["largest_planes"] = planes_json(processed.cloud);
  return json;
}

std::string sweep_in_words(const ProcessedSweep& processed) {
  const msg::Attitude& attitude = processed.attitude;
  std::string words = "sweep " + std::to_string(processed.index);
  if (attitude.mode() != 0) words += ", mode " + std::to_string(int{attitude.mode()});
  words += ": " + std::to_string(processed.sweep.lines_used()) + " of " +
           std::to_string(processed.sweep.lines_expected()) + " lines, " +
           verdict_word(attitude.verdict());
  if (attitude.verdict() == msg::VERDICT_GOOD) {
    words += ", phi_offset " + number(unwound_deg(attitude.phi_offset_deg()), 3) + " +- " +
             number(attitude.phi_offset_sigma_deg(), 3) + " deg";
  }
  if (!attitude.warning().empty()) words += "; " + attitude.warning();
  const std::string& reason =
      attitude.reason().empty() ? processed.sweep.reason() : attitude.reason();
  return reason.empty() ? words : words + " (" + reason + ")";
}

}  // namespace swivel
