#include "components/swivel/report/sweep_pictures.hpp"

#include <fmt/core.h>

#include <utility>

#include "calibration/transform_cloud.hpp"
#include "components/attitude_corrector/corrector.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/pictures/sweep_charts.hpp"

namespace swivel {
SweepPictures::SweepPictures(std::string folder, std::string title, RigFile rig)
    : folder_(std::move(folder)), title_(std::move(title)), rig_(std::move(rig)) {}

std::vector<Surface> SweepPictures::surfaces_of(const ProcessedSweep& processed) const {
  return find_surfaces(processed.cloud,
                       rig_.axis_measured ? SurfaceKind::kAny : SurfaceKind::kUpright);
}

std::string SweepPictures::path(const std::string& kind, std::size_t sweep) const {
  return fmt::format("{}/{}_{:02}.png", folder_, kind, sweep);
}

PictureCaption SweepPictures::caption_of(const ProcessedSweep& processed) const {
  const msg::Attitude& attitude = processed.attitude;
  const bool corrected = attitude.verdict() == msg::VERDICT_GOOD;
  PictureCaption caption;
  caption.title = title_;
  caption.sweep = processed.index;
  caption.mode = processed.sweep.mode();
  caption.verdict = verdict_word(attitude.verdict());
  caption.frame = rig_.axis_measured ? "base" : corrected ? "O" : "O' (not corrected)";
  if (corrected) caption.phi_offset_rad = rad_from_deg(attitude.phi_offset_deg());
  return caption;
}

void SweepPictures::draw(const ProcessedSweep& processed, const std::vector<Surface>& surfaces) {
  const msg::Attitude& attitude = processed.attitude;
  const PictureCaption caption = caption_of(processed);
  const auto drawn = [&](const std::string& kind) {
    return *drawn_.insert(path(kind, processed.index)).first;
  };
  require_written(write_surfaces_chart(drawn("surfaces"), surfaces, caption));
  drawn("top_view");  // the output folder draws it
  if (rig_.axis_measured) return;
  require_written(write_seam_chart(drawn("seam"), processed.cloud, surfaces,
                                   {attitude.seam_deg(), attitude.seam_sigma_deg()}, caption));
  if (rig_.plate) draw_plate(processed, caption);
}

void SweepPictures::draw_plate(const ProcessedSweep& processed, const PictureCaption& caption) {
  OrganisedCloud about_axis = processed.raw;
  transform_cloud(rig_.geometry.T_base_axis.inverse(), about_axis);
  std::optional<PlateBeta> beta;
  if (caption.phi_offset_rad)
    beta = PlateBeta{rad_from_deg(processed.attitude.beta_deg()),
                     rad_from_deg(processed.attitude.beta_sigma_deg())};
  const std::string file = path("plate", processed.index);
  require_written(write_plate_chart(file, beams_at_plate(about_axis, *rig_.plate, rig_.geometry),
                                    *rig_.plate, beta, caption));
  drawn_.insert(file);
}

}  // namespace swivel
