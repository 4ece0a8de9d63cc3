#include "hardware/lidar/line_fit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace swivel {
namespace {

LinePoint mean_of(const std::vector<LinePoint>& points) {
  LinePoint sum;
  for (const LinePoint& point : points) {
    sum.x += point.x;
    sum.y += point.y;
  }
  const auto count = static_cast<double>(points.size());
  return {sum.x / count, sum.y / count};
}

// The last block may be cut short, and its minimum too high: it counts only when it is alone.
std::vector<LinePoint> block_minima(const std::vector<LinePoint>& points, double block) {
  std::vector<LinePoint> minima;
  double end = 0.0;
  for (const LinePoint& point : points) {
    if (minima.empty() || point.x <= end) {
      minima.push_back(point);
      end = (std::floor(point.x / block)) * block;
      if (end == point.x) end -= block;
    } else if (point.y < minima.back().y) {
      minima.back() = point;
    }
  }
  if (minima.size() > 1 && points.back().x - 1.0 > end) minima.pop_back();
  return minima;
}

}  // namespace

FittedLine fit_line(const std::vector<LinePoint>& points, const SlopePrior& prior) {
  assert(!points.empty());
  const LinePoint mean = mean_of(points);
  double xx = prior.weight;
  double xy = prior.weight * prior.slope;
  for (const LinePoint& point : points) {
    xx += (point.x - mean.x) * (point.x - mean.x);
    xy += (point.x - mean.x) * (point.y - mean.y);
  }
  const double slope = xx > 0.0 ? xy / xx : prior.slope;
  return {mean.y - slope * mean.x, slope};
}

FittedLine fit_lower_envelope(const std::vector<LinePoint>& points, double block, double tolerance,
                              const SlopePrior& prior) {
  std::vector<LinePoint> kept = block_minima(points, block);
  for (;;) {
    const FittedLine line = fit_line(kept, prior);
    const auto too_high = std::remove_if(kept.begin(), kept.end(), [&](const LinePoint& point) {
      return point.y > line.at(point.x) + tolerance;
    });
    if (too_high == kept.end()) return line;
    kept.erase(too_high, kept.end());
  }
}

}  // namespace swivel
