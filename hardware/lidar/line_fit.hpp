// Least-squares lines of which something is known beforehand. Private to hardware/lidar.
#pragma once

#include <vector>

namespace swivel {

struct LinePoint {
  double x = 0.0;
  double y = 0.0;
};

struct FittedLine {
  double at_zero = 0.0;
  double slope = 0.0;
  double at(double x) const { return at_zero + slope * x; }
};

// What is known of the slope before the first point. `weight` is the variance of a point over
// that of the prior, in units of x squared: few points keep the prior, many forget it.
struct SlopePrior {
  double slope = 0.0;
  double weight = 0.0;
};

// At least one point.
FittedLine fit_line(const std::vector<LinePoint>& points, const SlopePrior& prior);

// The line under which almost nothing lies: for points with an error that is mostly small and
// sometimes large, but never negative. `points` in falling order of x, from 0 on; of every
// `block` units of x the lowest counts, and those more than `tolerance` above the line do not.
FittedLine fit_lower_envelope(const std::vector<LinePoint>& points, double block, double tolerance,
                              const SlopePrior& prior);

}  // namespace swivel
