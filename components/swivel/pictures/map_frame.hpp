// Which part of a cloud a top view shows, and where its points come to lie on the paper.
#pragma once

#include <optional>
#include <vector>

#include "calibration/organised_cloud.hpp"

namespace swivel {

// Heights between floor and ceiling. Seen from above these two hide the walls.
struct HeightBand {
  float lowest_m;
  float highest_m;

  bool holds(const CloudPoint& point) const {
    return point.valid() && point.z_m > lowest_m && point.z_m < highest_m;
  }
};

// A floor or a ceiling is a height at which far more points lie than at others, below or above
// the sensor; without one the band is open on that side.
HeightBand band_between_floor_and_ceiling(const OrganisedCloud& cloud);

struct Pixel {
  int column;
  int row;
};

// Equal axes, X right, Y up.
class MapFrame {
 public:
  // Shows what of the clouds lies in the band, and the origin; a few stray points are left out.
  MapFrame(const std::vector<const OrganisedCloud*>& clouds, const HeightBand& band,
           int width_pixels, int height_pixels);

  std::optional<Pixel> pixel_of(const CloudPoint& point) const;  // nothing outside of the map
  double column_of(double x_m) const { return (x_m - left_m_) * pixels_per_m_; }
  double row_of(double y_m) const { return (top_m_ - y_m) * pixels_per_m_; }

  double left_m() const { return left_m_; }
  double right_m() const { return left_m_ + width_ / pixels_per_m_; }
  double top_m() const { return top_m_; }
  double bottom_m() const { return top_m_ - height_ / pixels_per_m_; }
  double pixels_per_m() const { return pixels_per_m_; }

 private:
  int width_;
  int height_;
  double pixels_per_m_ = 100.0;
  double left_m_ = 0.0;
  double top_m_ = 0.0;
};

}  // namespace swivel
