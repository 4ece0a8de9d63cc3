// A case folder: meta.csv, lines.csv, ranges.u16, intensity.u16. The truth beside them is not
// read.
#pragma once

#include <string>

#include "components/recording/recording_plan.hpp"
#include "hardware/result.hpp"

namespace swivel {

Result<RecordingPlan> plan_case_folder(const std::string& folder);

}  // namespace swivel
