// What a beam can meet. Frame O: origin at the lidar's height on the motor axis, Z up along
// the axis, X to the rig's front.
#pragma once

#include <optional>

#include "hardware/sim/vector3.hpp"

namespace swivel::sim {

struct Ray {
  Vector3 origin;     // m
  Vector3 direction;  // of length 1
};

struct Hit {
  double distance_m = 0.0;
  double cos_incidence = 1.0;  // 1: the beam meets the surface squarely
  double reflectivity = 0.5;   // 0 black, 1 white
  int surface = 0;             // which one of the world's
};

// A wall, floor or roof, seen from the side to which its normal points.
struct Wall {
  Vector3 point;
  Vector3 inward_normal;
  double reflectivity = 0.5;
};

// An upright box. `length` is the level direction of its own x.
struct Box {
  Vector3 centre;
  Vector3 half_size;
  Vector3 length{1.0, 0.0, 0.0};
  double reflectivity = 0.5;
};

// An isosceles right triangle. `foot` is the middle of the base edge, `along` points from
// there to the right angle, `across` along the base edge.
struct Triangle {
  Vector3 foot;
  Vector3 along;
  Vector3 across;
  double half_base_m = 0.0;
  double reflectivity = 0.5;
};

std::optional<Hit> cast(const Ray& ray, const Wall& wall);
std::optional<Hit> cast(const Ray& ray, const Box& box);
std::optional<Hit> cast(const Ray& ray, const Triangle& triangle);

}  // namespace swivel::sim
