// Pictures of a sweep seen from above, as PNG: metres, X right, Y up, equal axes, floor and
// ceiling cut away. Colours after Okabe and Ito; scalars in cividis.
#pragma once

#include <optional>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "hardware/result.hpp"

namespace swivel {

inline constexpr int kPictureWidth_pixels = 1200;
inline constexpr int kPictureHeight_pixels = 1320;

struct PictureCaption {
  std::string title;                     // what is seen: the recording's or the rig's name
  std::string frame;                     // name of the frame at the origin: O, O', base
  std::size_t sweep = 0;                 // counted from 0
  int mode = 0;                          // 0: none of the seven
  std::string verdict;                   // in words
  std::optional<double> phi_offset_rad;  // where known: counter-clockwise seen from above
  bool uncorrected = false;              // the attitude is not known: the cloud is as it came
};

// before: the cloud as assembled, in frame O' (vermillion); after: the corrected one (blue).
// A rig that measures its axis has no `before`; a cloud that is not corrected has none either, and
// is vermillion itself. The seam, where the sweep began and ended, is
// drawn where phi_offset is known.
Outcome write_top_view(const std::string& path, const OrganisedCloud* before,
                       const OrganisedCloud& after, const PictureCaption& caption);

// How many points lie above one another, on a logarithmic scale.
Outcome write_density_view(const std::string& path, const OrganisedCloud& cloud,
                           const PictureCaption& caption);

}  // namespace swivel
