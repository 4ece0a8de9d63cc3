// What a run over sweeps leaves behind: attitude.csv, report.json, and for each sweep its cloud
// as PCD and PLY and its pictures. The last sweep's also stand under names without a number.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "components/common/rig_file.hpp"
#include "components/swivel/offline/processed_sweep.hpp"

namespace swivel {

struct OutputKinds {
  bool no_clouds = false;
  bool no_pictures = false;
};

// Numbers that only the caller knows of a sweep, for its report.
using Remark = std::function<nlohmann::ordered_json(const ProcessedSweep&)>;

class OutputFolder {
 public:
  // Makes the folder. title: what stands over the pictures. Throws ExitError.
  OutputFolder(std::string folder, std::string title, const RigFile& rig, OutputKinds kinds);

  // A number or a word about the whole run, into report.json.
  void note(const std::string& key, nlohmann::ordered_json value) {
    report_[key] = std::move(value);
  }

  // Writes what belongs to the sweep, and a line about it to stdout. more: into its report.
  void add(const ProcessedSweep& processed, const nlohmann::ordered_json& more = {});

  void finish() const;

  std::size_t sweeps() const { return report_["sweeps"].size(); }

 private:
  std::string path(const std::string& kind, std::size_t index, const std::string& ending) const;
  void write_clouds(const ProcessedSweep& processed, nlohmann::ordered_json& json) const;
  void write_pictures(const ProcessedSweep& processed, nlohmann::ordered_json& json) const;
  void name_last(const std::string& kind, const std::string& ending) const;

  std::string folder_;
  std::string title_;
  bool measured_;
  OutputKinds kinds_;
  std::string attitude_csv_;
  nlohmann::ordered_json report_;
  std::size_t last_index_ = 0;
};

}  // namespace swivel
