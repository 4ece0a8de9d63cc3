#include "components/swivel/offline/output_folder.hpp"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "components/attitude_corrector/corrector.hpp"
#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
#include "components/swivel/offline/cloud_files.hpp"
#include "components/swivel/offline/sweep_report.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/pictures/pictures.hpp"

namespace swivel {
namespace {

namespace fs = std::filesystem;

}  // namespace

OutputFolder::OutputFolder(std::string folder, std::string title, const RigFile& rig,
                           OutputKinds kinds)
    : folder_(std::move(folder)),
      title_(std::move(title)),
      measured_(rig.axis_measured),
      kinds_(kinds),
      attitude_csv_(attitude_csv_heading()) {
  make_folder(folder_);
  report_["version"] = SWIVEL_VERSION;
  report_["rig_file"] = rig.path;
  report_["estimator"] = rig.axis_measured ? "" : rig.estimator;
  report_["sign_of_phi_offset"] =
      "counter-clockwise seen from above; turns a cloud from its start position O' into O";
  report_["sweeps"] = nlohmann::ordered_json::array();
}

void OutputFolder::add(const ProcessedSweep& processed, const nlohmann::ordered_json& more) {
  attitude_csv_ += attitude_csv_row(processed);
  nlohmann::ordered_json json = sweep_json(processed);
  if (!more.is_null()) json.update(more);
  if (!processed.cloud.points.empty()) {
    if (!kinds_.no_clouds) write_clouds(processed, json);
    if (!kinds_.no_pictures) write_pictures(processed, json);
  }
  report_["sweeps"].push_back(std::move(json));
  last_index_ = processed.index;
  std::cout << sweep_in_words(processed) << std::endl;
}

void OutputFolder::finish() const {
  write_text_file(folder_ + "/attitude.csv", attitude_csv_);
  write_text_file(folder_ + "/report.json", json_text(report_, 2) + "\n");
  name_last("cloud", ".pcd");
  name_last("cloud", ".ply");
  name_last("top_view", ".png");
  name_last("density", ".png");
}

// The same file under a second name; a copy where the file system has no links.
void OutputFolder::name_last(const std::string& kind, const std::string& ending) const {
  const std::string numbered = path(kind, last_index_, ending);
  const std::string plain = folder_ + "/" + kind + ending;
  std::error_code error;
  fs::remove(plain, error);
  if (!fs::exists(numbered)) return;
  fs::create_hard_link(numbered, plain, error);
  if (error) fs::copy_file(numbered, plain, error);
  if (error) throw ExitError(kExitInputOutput, plain + ": " + error.message());
}

std::string OutputFolder::path(const std::string& kind, std::size_t index,
                               const std::string& ending) const {
  std::ostringstream name;
  name << folder_ << "/" << kind << "_" << std::setw(2) << std::setfill('0') << index << ending;
  return name.str();
}

void OutputFolder::write_clouds(const ProcessedSweep& processed,
                                nlohmann::ordered_json& json) const {
  require_written(write_pcd(path("cloud", processed.index, ".pcd"), processed.cloud));
  const auto left_out = write_ply(path("cloud", processed.index, ".ply"), processed.cloud);
  if (!left_out) throw ExitError(kExitInputOutput, left_out.reason());
  json["invalid_points_left_out_of_ply"] = *left_out;
}

void OutputFolder::write_pictures(const ProcessedSweep& processed,
                                  nlohmann::ordered_json& json) const {
  const bool corrected = processed.attitude.verdict() == msg::VERDICT_GOOD;
  PictureCaption caption;
  caption.title = title_;
  caption.sweep = processed.index;
  caption.mode = processed.attitude.mode();
  caption.verdict = verdict_word(processed.attitude.verdict());
  caption.uncorrected = !Corrector::in_base(processed.attitude.verdict());
  caption.frame = measured_ ? "base" : corrected ? "O" : "O'";
  if (corrected) caption.phi_offset_rad = rad_from_deg(processed.attitude.phi_offset_deg());
  const std::string top_view = path("top_view", processed.index, ".png");
  require_written(
      write_top_view(top_view, corrected ? &processed.raw : nullptr, processed.cloud, caption));
  require_written(
      write_density_view(path("density", processed.index, ".png"), processed.cloud, caption));
  json["top_view"] = fs::path(top_view).filename();
}

}  // namespace swivel
