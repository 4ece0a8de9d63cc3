// A mounting as it stands in mounting.json and report.json.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "calibration/mounting.hpp"

namespace swivel {

// sweeps: counted from 0, those that were seen from one place.
nlohmann::ordered_json mounting_json(const std::vector<std::size_t>& sweeps,
                                     const MountingFit& fit);

// Mean deviations of the roof's points, by kRoofStepNames.
nlohmann::ordered_json roof_json(const std::vector<double>& means_m);

}  // namespace swivel
