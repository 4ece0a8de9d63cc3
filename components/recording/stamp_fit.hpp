// When the lines of a recording began, from a counter that is read once a line.
//
// A lidar turns evenly, its counter ticks coarsely: the line t = t0 + n * period through all
// stamps knows both better than any one stamp. Several sweeps share one period, each has a t0
// of its own (ordinary least squares with a common slope).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace swivel {

struct StampedLine {
  std::int64_t number = 0;  // of the line in its sweep: a hole is a line that is missing
  double stamp_ns = 0.0;    // unwrapped, of any origin
};

struct StampFit {
  double period_ns = 0.0;
  std::vector<double> first_ns;  // of line number 0, one a sweep
};

// `nominal_period_ns` is used where no sweep has two lines.
StampFit fit_stamps(const std::vector<std::vector<StampedLine>>& sweeps, double nominal_period_ns);

// How far a line's stamp is from where the others put it.
double residual_ns(const StampFit& fit, std::size_t sweep, const StampedLine& line);

}  // namespace swivel
