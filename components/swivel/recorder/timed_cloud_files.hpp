// Clouds in files that have a time for every point: LAS 1.2, and CSV for spreadsheets. Invalid
// points are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "calibration/organised_cloud.hpp"

namespace swivel {

// Beam k of line n was fired at first_ns + n line_period_ns + k beam_period_ns.
struct PointTimes {
  std::int64_t first_ns = 0;
  double line_period_ns = 0.0;
  double beam_period_ns = 0.0;

  std::int64_t of(std::size_t line, std::size_t beam) const;
};

// Point format 1: to 0.1 mm, intensity up to 65535, adjusted standard GPS time.
std::string las_bytes(const OrganisedCloud& cloud, const PointTimes& times);

// x_m,y_m,z_m,intensity,time_ns
std::string csv_text(const OrganisedCloud& cloud, const PointTimes& times);

}  // namespace swivel
