// Evaluates sweeps as they come: looks closely at each, and at the end at all together. Writes
// pictures and report.html into a folder, the numbers into its report.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/common/rig_file.hpp"
#include "components/swivel/offline/output_folder.hpp"
#include "components/swivel/offline/processed_sweep.hpp"
#include "components/swivel/report/attitude_truth.hpp"
#include "components/swivel/report/findings.hpp"
#include "components/swivel/report/mounting_evaluator.hpp"
#include "components/swivel/report/report_page.hpp"
#include "components/swivel/report/surfaces.hpp"
#include "components/swivel/report/sweep_pictures.hpp"

namespace swivel {

class SweepEvaluator {
 public:
  // The folder must be there. title: what was scanned.
  SweepEvaluator(std::string folder, std::string title, const RigFile& rig, double room_yaw_deg);

  // Draws the sweep's pictures. Returns what belongs into its report.
  nlohmann::ordered_json add(const ProcessedSweep& processed);

  // After the last sweep, before output.finish().
  void finish(const std::optional<AttitudeTruth>& truth, OutputFolder& output);

 private:
  void judge_errors(const std::optional<AttitudeTruth>& truth);
  std::vector<const SweepFacts*> sweeps_to_show() const;
  std::vector<Figure> figures_of_all() const;
  std::vector<Figure> figures_of_sweeps() const;
  std::string label_of(const SweepFacts& sweep) const;
  PageHead page_head() const;

  std::string folder_;
  std::string title_;
  RigFile rig_;
  SweepPictures pictures_;
  double room_yaw_rad_;
  Evaluation evaluation_;
  MountingEvaluator mounting_;
  std::vector<std::vector<Plane>> walls_;        // a sweep each
  std::vector<std::uint32_t> device_stamps_ms_;  // likewise
};

}  // namespace swivel
