#include "components/swivel/offline/mounting_json.hpp"

#include <string>

#include "calibration/roof_steps.hpp"

namespace swivel {
namespace {

using Json = nlohmann::ordered_json;

void put(Json& json, const std::string& name, const std::string& unit, const MountingFit& fit,
         MountingValue value, double per_unit) {
  json[name + "_" + unit] = per_unit * fit.solution.value[value];
  json[name + "_sigma_" + unit] = per_unit * fit.sigma_of(value);
}

void put_values(Json& json, const MountingFit& fit) {
  put(json, "bias", "deg", fit, kMountingBias, deg_from_rad(1.0));
  put(json, "ry", "deg", fit, kMountingTilt, deg_from_rad(1.0));
  put(json, "tx", "mm", fit, kMountingLeverX, mm_from_m(1.0));
  put(json, "ty", "mm", fit, kMountingLeverY, mm_from_m(1.0));
  if (is_seen(fit.solution, kAxisHysteresis))
    put(json, "hysteresis", "deg", fit, kAxisHysteresis, deg_from_rad(1.0));
  if (is_seen(fit.solution, kRangeOffset))
    put(json, "range_offset", "mm", fit, kRangeOffset, mm_from_m(1.0));
}

Json steps_of(const MountingFit& fit) {
  const SymmetricRaysFit& rays = fit.symmetric_rays;
  Json steps;
  steps["symmetric_rays"] = {{"bias_deg", deg_from_rad(rays.bias_rad)},
                             {"bias_sigma_deg", deg_from_rad(rays.sigma_rad)},
                             {"verified", rays.verified},
                             {"second_half_off_deg", deg_from_rad(rays.second_half_off_rad)},
                             {"pairs", rays.pairs},
                             {"attempts", rays.attempts},
                             {"reason", rays.reason}};
  if (!fit.half_scans) return steps;
  const MountingVector& value = fit.half_scans->solution.value;
  steps["half_scans"] = {{"bias_deg", deg_from_rad(value[kMountingBias])},
                         {"ry_deg", deg_from_rad(value[kMountingTilt])},
                         {"tx_mm", mm_from_m(value[kMountingLeverX])},
                         {"ty_mm", mm_from_m(value[kMountingLeverY])},
                         {"cells", fit.half_scans->cells}};
  return steps;
}

}  // namespace

Json mounting_json(const std::vector<std::size_t>& sweeps, const MountingFit& fit) {
  Json json;
  if (sweeps.size() == 1) json["sweep"] = sweeps.front();
  json["sweeps"] = sweeps;
  put_values(json, fit);
  json["unobservable"] = fit.unobservable;
  json["advice"] = fit.advice;
  json["residual_mm"] = mm_from_m(fit.residual_m);
  if (fit.thickness.mounted_m > 0.0) {
    json["largest_planes_nominal_mm"] = mm_from_m(fit.thickness.nominal_m);
    json["largest_planes_mm"] = mm_from_m(fit.thickness.mounted_m);
  }
  if (fit.apart) {
    json["views_apart_nominal_mm"] = mm_from_m(fit.apart->nominal_m);
    json["views_apart_mm"] = mm_from_m(fit.apart->mounted_m);
  }
  json["rays_on_planes"] = fit.rays;
  json["cells_seen_twice"] = fit.cells;
  if (fit.symmetric_rays.attempts > 0 || fit.half_scans) json["steps"] = steps_of(fit);
  return json;
}

Json roof_json(const std::vector<double>& means_m) {
  Json json;
  for (std::size_t step = 0; step < means_m.size(); ++step)
    json[kRoofStepNames.at(step)] = mm_from_m(means_m[step]);
  return json;
}

}  // namespace swivel
