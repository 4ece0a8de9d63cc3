#include "calibration/sweep_readings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace swivel {

double median_range_m(const SweepReadings& readings) {
  std::vector<float> ranges_m;
  for (const LineOfReadings& line : readings.lines) {
    std::copy_if(line.ranges_m.begin(), line.ranges_m.end(), std::back_inserter(ranges_m),
                 [](float range_m) { return !std::isnan(range_m); });
  }
  if (ranges_m.empty()) return 0.0;
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::nth_element(ranges_m.begin(), middle, ranges_m.end());
  return static_cast<double>(*middle);
}

}  // namespace swivel
