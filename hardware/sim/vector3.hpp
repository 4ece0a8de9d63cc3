// Just enough arithmetic to cast rays. The bench shares no geometry with calibration/, on
// purpose: a sign error in both would cancel out.
#pragma once

#include <cmath>

namespace swivel::sim {

struct Vector3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

inline Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3 operator*(double factor, const Vector3& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}
inline double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Counter-clockwise seen from the tip of the axis; about Z: from above.
inline Vector3 turned_about_x(const Vector3& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}
inline Vector3 turned_about_y(const Vector3& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}
inline Vector3 turned_about_z(const Vector3& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;

}  // namespace swivel::sim
