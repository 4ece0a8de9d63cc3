// What the sweeps of a rig that measures its axis say of its mounting, for the report: the figures
// of Zeng 2018.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/swivel/offline/mounting_pictures.hpp"
#include "components/swivel/offline/processed_sweep.hpp"
#include "components/swivel/report/attitude_truth.hpp"
#include "components/swivel/report/report_page.hpp"

namespace swivel {

class MountingEvaluator {
 public:
  // As MountingPictures.
  MountingEvaluator(std::string folder, std::string title, const RigGeometry& nominal);

  // Fits the sweep's mounting, which takes seconds, and draws it. Returns what belongs into its
  // report; nothing where the sweep's readings are not known, as live.
  nlohmann::ordered_json add(const ProcessedSweep& processed);

  std::vector<Figure> figures(const std::optional<AttitudeTruth>& truth) const;

 private:
  RigGeometry nominal_;
  MountingPictures pictures_;
};

}  // namespace swivel
