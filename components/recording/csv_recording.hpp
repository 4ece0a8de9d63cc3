// A recording of a real scanner in one .csv.gz file.
#pragma once

#include <string>

#include "components/recording/recording_plan.hpp"
#include "hardware/result.hpp"

namespace swivel {

// A sweep is a run of lines during which the axis turns one way; the lines at which it stands
// still or turns back belong to none.
Result<RecordingPlan> plan_csv_recording(const std::string& path);

}  // namespace swivel
