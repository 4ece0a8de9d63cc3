#include "hardware/sim/surfaces.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace swivel::sim {
namespace {

constexpr double kNothing = 1e-12;

// Where a ray is between two parallel faces: [in, out] in metres along the ray.
struct Slab {
  double in = -std::numeric_limits<double>::infinity();
  double out = std::numeric_limits<double>::infinity();
};

Slab between(double origin, double direction, double half_size) {
  if (std::abs(direction) < kNothing) {
    return std::abs(origin) <= half_size ? Slab{} : Slab{1.0, -1.0};
  }
  const double a = (-half_size - origin) / direction;
  const double b = (half_size - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

// `v` in the frame whose X is `length`, which is level.
Vector3 seen_along(const Vector3& length, const Vector3& v) {
  return {dot(length, v), length.x * v.y - length.y * v.x, v.z};
}

}  // namespace

std::optional<Hit> cast(const Ray& ray, const Wall& wall) {
  const double approach = -dot(ray.direction, wall.inward_normal);
  if (approach < kNothing) return std::nullopt;
  const double distance = dot(ray.origin - wall.point, wall.inward_normal) / approach;
  if (distance < 0.0) return std::nullopt;
  return Hit{distance, approach, wall.reflectivity};
}

std::optional<Hit> cast(const Ray& ray, const Box& box) {
  const Vector3 origin = seen_along(box.length, ray.origin - box.centre);
  const Vector3 direction = seen_along(box.length, ray.direction);
  const Slab x = between(origin.x, direction.x, box.half_size.x);
  const Slab y = between(origin.y, direction.y, box.half_size.y);
  const Slab z = between(origin.z, direction.z, box.half_size.z);
  const double in = std::max({x.in, y.in, z.in});
  const double out = std::min({x.out, y.out, z.out});
  if (in > out || in < 0.0) return std::nullopt;
  double facing = direction.z;
  if (in == x.in) facing = direction.x;
  if (in == y.in) facing = direction.y;
  return Hit{in, std::abs(facing), box.reflectivity};
}

std::optional<Hit> cast(const Ray& ray, const Triangle& triangle) {
  const Vector3 normal = cross(triangle.along, triangle.across);
  const double approach = dot(ray.direction, normal);
  if (std::abs(approach) < kNothing) return std::nullopt;
  const double distance = dot(triangle.foot - ray.origin, normal) / approach;
  if (distance < 0.0) return std::nullopt;
  const Vector3 from_foot = ray.origin + distance * ray.direction - triangle.foot;
  const double along = dot(from_foot, triangle.along);
  const double across = dot(from_foot, triangle.across);
  if (along < 0.0 || std::abs(across) > triangle.half_base_m - along) return std::nullopt;
  return Hit{distance, std::abs(approach), triangle.reflectivity};
}

}  // namespace swivel::sim
