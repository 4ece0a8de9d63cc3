// Close looks at one sweep, as PNG: its walls (fig. A2 of Yuan 2021), its seam, its plate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/organised_cloud.hpp"
#include "calibration/plate_view.hpp"
#include "components/swivel/pictures/pictures.hpp"
#include "components/swivel/report/surfaces.hpp"
#include "hardware/result.hpp"

namespace swivel {

// A row a surface: distance from the fitted plane along it and up it, and its histogram.
Outcome write_surfaces_chart(const std::string& path, const std::vector<Surface>& surfaces,
                             const PictureCaption& caption);

// What the message said of the seam. NaN where not known.
struct SeamSaid {
  double further_deg;
  double sigma_deg;
};

// Seen from above the points of the sweep's first quarter (blue) and of its last (vermillion);
// and at both places where they meet, how far they lie off the wall that they share.
Outcome write_seam_chart(const std::string& path, const OrganisedCloud& cloud,
                         const std::vector<Surface>& walls, const SeamSaid& said,
                         const PictureCaption& caption);

// The beams that come down in the half ring about the plate, seen from above in O': those that
// met it (blue) and those that did not (orange), and the plate as drawn, at beta if that is known.
struct PlateBeta {
  double beta_rad;
  double sigma_rad;
};
Outcome write_plate_chart(const std::string& path, const std::vector<PlateBeam>& beams,
                          const PlateGeometry& plate, const std::optional<PlateBeta>& beta,
                          const PictureCaption& caption);

}  // namespace swivel
