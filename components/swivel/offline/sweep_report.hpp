// What is written about sweeps: attitude.csv and report.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "components/swivel/offline/processed_sweep.hpp"

namespace swivel {

// One row; beta, phi_offset and sigma are nan where they are not known.
std::string attitude_csv_heading();
std::string attitude_csv_row(const ProcessedSweep& processed);

// Numbers of one sweep, with its largest planes; what is not known is null.
nlohmann::ordered_json sweep_json(const ProcessedSweep& processed);

// For a person: one line.
std::string sweep_in_words(const ProcessedSweep& processed);

}  // namespace swivel
