// The evaluation as it stands in report.json.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "components/swivel/report/findings.hpp"
#include "components/swivel/report/surfaces.hpp"

namespace swivel {

nlohmann::ordered_json evaluation_json(const Evaluation& evaluation);
nlohmann::ordered_json surfaces_json(const std::vector<Surface>& surfaces);

}  // namespace swivel
