// What a participant said of its health, as JSON: for `swivel status --json` and the page.
#pragma once

#include <nlohmann/json.hpp>

#include "components/common/roll.hpp"

namespace swivel {

nlohmann::ordered_json to_json(const RollEntry& entry);

}  // namespace swivel
