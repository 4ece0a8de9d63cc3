#include "components/swivel/pictures/map_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace swivel {
namespace {

constexpr float kSlice_m = 0.05F;
constexpr std::size_t kFarMorePoints = 5;  // times the usual number of a slice
constexpr float kMargin_m = 0.12F;         // floor and ceiling have noise and skirtings
constexpr double kStray = 0.002;           // part of the points at each side that may be cut off
constexpr double kMargin = 0.06;           // of the map, at each side

struct Interval {
  double lowest = 0.0;
  double highest = 0.0;
};

// What holds the values but for the strays, and zero.
Interval extent(std::vector<float>& values) {
  if (values.empty()) return {-1.0, 1.0};
  std::sort(values.begin(), values.end());
  const auto strays = static_cast<std::size_t>(kStray * static_cast<double>(values.size()));
  return {std::min(0.0, static_cast<double>(values[strays])),
          std::max(0.0, static_cast<double>(values[values.size() - 1 - strays]))};
}

std::size_t usual_count(const std::map<int, std::size_t>& slices) {
  std::vector<std::size_t> counts;
  counts.reserve(slices.size());
  for (const auto& [slice, count] : slices) counts.push_back(count);
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  return *middle;
}

}  // namespace

HeightBand band_between_floor_and_ceiling(const OrganisedCloud& cloud) {
  HeightBand band{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  std::map<int, std::size_t> slices;
  for (const CloudPoint& point : cloud.points)
    if (point.valid()) ++slices[static_cast<int>(std::floor(point.z_m / kSlice_m))];
  if (slices.empty()) return band;

  const std::size_t many = kFarMorePoints * std::max<std::size_t>(usual_count(slices), 1);
  for (const auto& [slice, count] : slices) {
    if (count < many) continue;
    const float bottom_m = static_cast<float>(slice) * kSlice_m;
    if (bottom_m < -0.3F) band.lowest_m = bottom_m + kSlice_m + kMargin_m;
    if (bottom_m > 0.3F) band.highest_m = std::min(band.highest_m, bottom_m - kMargin_m);
  }
  return band;
}

MapFrame::MapFrame(const std::vector<const OrganisedCloud*>& clouds, const HeightBand& band,
                   int width_pixels, int height_pixels)
    : width_(width_pixels), height_(height_pixels) {
  std::vector<float> xs_m, ys_m;
  for (const OrganisedCloud* cloud : clouds) {
    for (const CloudPoint& point : cloud->points) {
      if (!band.holds(point)) continue;
      xs_m.push_back(point.x_m);
      ys_m.push_back(point.y_m);
    }
  }
  const Interval x_m = extent(xs_m), y_m = extent(ys_m);
  const double shown = 1.0 - 2.0 * kMargin;
  const double across_m = std::max(x_m.highest - x_m.lowest, 0.1);
  const double along_m = std::max(y_m.highest - y_m.lowest, 0.1);
  pixels_per_m_ = shown * std::min(width_ / across_m, height_ / along_m);
  left_m_ = 0.5 * (x_m.lowest + x_m.highest) - 0.5 * width_ / pixels_per_m_;
  top_m_ = 0.5 * (y_m.lowest + y_m.highest) + 0.5 * height_ / pixels_per_m_;
}

std::optional<Pixel> MapFrame::pixel_of(const CloudPoint& point) const {
  const double column = column_of(static_cast<double>(point.x_m));
  const double row = row_of(static_cast<double>(point.y_m));
  const bool inside = column >= 0.0 && column < width_ && row >= 0.0 && row < height_;
  if (!inside) return std::nullopt;
  return Pixel{static_cast<int>(column), static_cast<int>(row)};
}

}  // namespace swivel
