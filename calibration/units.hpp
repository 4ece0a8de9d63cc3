// The one home of conversions between the units inside (metres, radians, seconds as double,
// nanoseconds as int64) and those on the wire and in files (mm, deg).
#pragma once

#include <cstdint>

namespace swivel {

inline constexpr double kPi = 3.14159265358979323846;

constexpr double rad_from_deg(double angle_deg) {
  return angle_deg * (kPi / 180.0);
}
constexpr double deg_from_rad(double angle_rad) {
  return angle_rad * (180.0 / kPi);
}
constexpr double m_from_mm(double length_mm) {
  return length_mm * 1e-3;
}
constexpr double mm_from_m(double length_m) {
  return length_m * 1e3;
}
constexpr double s_from_ns(double time_ns) {
  return time_ns * 1e-9;
}
constexpr double ns_from_s(double time_s) {
  return time_s * 1e9;
}

}  // namespace swivel
