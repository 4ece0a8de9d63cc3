// Where one frame stands in another, by numbers that a person can measure; and the same worked
// out once, for many points.
#pragma once

#include "hardware/sim/vector3.hpp"

namespace swivel::sim {

struct Placement {
  Vector3 xyz_mm;
  Vector3 rpy_deg;  // turned about the outer frame's X, then its Y, then its Z
};

class Pose {
 public:
  explicit Pose(const Placement& placement)
      : x_(turned({1.0, 0.0, 0.0}, placement.rpy_deg)),
        y_(turned({0.0, 1.0, 0.0}, placement.rpy_deg)),
        z_(turned({0.0, 0.0, 1.0}, placement.rpy_deg)),
        origin_m_(1e-3 * placement.xyz_mm) {}

  Vector3 direction(const Vector3& inner) const {
    return inner.x * x_ + inner.y * y_ + inner.z * z_;
  }
  Vector3 point(const Vector3& inner_m) const { return origin_m_ + direction(inner_m); }

 private:
  // The axes of the inner frame, seen from the outer one.
  static Vector3 turned(const Vector3& axis, const Vector3& rpy_deg) {
    const Vector3 rolled = turned_about_x(axis, rpy_deg.x * kRadPerDeg);
    const Vector3 pitched = turned_about_y(rolled, rpy_deg.y * kRadPerDeg);
    return turned_about_z(pitched, rpy_deg.z * kRadPerDeg);
  }

  Vector3 x_;
  Vector3 y_;
  Vector3 z_;
  Vector3 origin_m_;
};

}  // namespace swivel::sim
