// What lidar and axis said in a sweep, before any geometry: ranges, and the axis angle of each
// line. Mountings are estimated from it.
#pragma once

#include <cstddef>
#include <vector>

namespace swivel {

struct LineOfReadings {
  double axis_angle_rad = 0.0;      // at the first beam
  double angle_per_beam_rad = 0.0;  // the axis turns evenly within a line
  bool turning_down = false;        // in a sweep in which the axis angle falls
  std::vector<float> ranges_m;      // one a beam; NaN where there is none
};

struct SweepReadings {
  double first_beam_angle_rad = 0.0;
  double beam_step_rad = 0.0;
  std::vector<LineOfReadings> lines;  // those that are there

  std::size_t beams() const { return lines.empty() ? 0 : lines.front().ranges_m.size(); }
};

// How far away things are; 0 without any range.
double median_range_m(const SweepReadings& readings);

}  // namespace swivel
