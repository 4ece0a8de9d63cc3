// A sweep's points, organised: a row a scan line, a column a beam, in the order fired.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace swivel {

// The memory layout of a point in PointCloud2 as we publish it.
struct CloudPoint {
  float x_m;
  float y_m;
  float z_m;
  float intensity;  // as the sensor says; NaN where the line is missing

  bool valid() const { return !std::isnan(x_m); }
};
static_assert(sizeof(CloudPoint) == 16, "clouds are copied to the wire as they are");

inline constexpr CloudPoint kMissingPoint{
    std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN(),
    std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};

struct OrganisedCloud {
  std::size_t lines = 0;
  std::size_t beams = 0;
  std::vector<CloudPoint> points;  // lines * beams

  OrganisedCloud() = default;
  OrganisedCloud(std::size_t line_count, std::size_t beam_count)
      : lines(line_count), beams(beam_count), points(line_count * beam_count, kMissingPoint) {}

  CloudPoint* line(std::size_t index) { return points.data() + index * beams; }
  const CloudPoint* line(std::size_t index) const { return points.data() + index * beams; }

  // A line that never came. A line that came has an intensity, be it 0, at every beam.
  bool line_missing(std::size_t index) const {
    return beams == 0 || std::isnan(line(index)->intensity);
  }
};

}  // namespace swivel
