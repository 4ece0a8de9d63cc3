#include "hardware/sim/world.hpp"

#include <stdexcept>

namespace swivel::sim {
namespace {

constexpr double kMetre = 1e-3;  // of a millimetre

Wall turned(const Wall& wall, double yaw_rad) {
  return {turned_about_z(wall.point, yaw_rad), turned_about_z(wall.inward_normal, yaw_rad),
          wall.reflectivity};
}

std::vector<Wall> walls_of(const RoomOptions& room) {
  const Vector3 front_normal = turned_about_z({-1.0, 0.0, 0.0}, room.front_skew_deg * kRadPerDeg);
  const std::vector<Wall> square = {
      {{room.front_mm * kMetre, 0.0, 0.0}, front_normal, 0.8},
      {{room.back_mm * kMetre, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.8},
      {{0.0, room.left_mm * kMetre, 0.0}, {0.0, -1.0, 0.0}, 0.8},
      {{0.0, room.right_mm * kMetre, 0.0}, {0.0, 1.0, 0.0}, 0.8},
      {{0.0, 0.0, room.floor_mm * kMetre}, {0.0, 0.0, 1.0}, 0.3},
      {{0.0, 0.0, room.roof_mm * kMetre}, {0.0, 0.0, -1.0}, 0.85},
  };
  std::vector<Wall> walls;
  walls.reserve(square.size());
  for (const Wall& wall : square) walls.push_back(turned(wall, room.yaw_deg * kRadPerDeg));
  return walls;
}

Box box_of(const Furniture& piece, double room_yaw_rad) {
  Box box;
  box.centre = turned_about_z(
      {piece.x_mm * kMetre, piece.y_mm * kMetre, 0.5 * (piece.bottom_mm + piece.top_mm) * kMetre},
      room_yaw_rad);
  box.half_size =
      0.5 * kMetre * Vector3{piece.length_mm, piece.width_mm, piece.top_mm - piece.bottom_mm};
  box.length = turned_about_z({1.0, 0.0, 0.0}, room_yaw_rad + piece.yaw_deg * kRadPerDeg);
  box.reflectivity = piece.reflectivity;
  return box;
}

Box clutter_of(const ClutterOptions& clutter, double plate_depth_mm) {
  Box box;
  box.centre = turned_about_z({clutter.distance_mm * kMetre, 0.0, -plate_depth_mm * kMetre},
                              clutter.azimuth_deg * kRadPerDeg);
  box.half_size = 0.5 * clutter.size_mm * kMetre * Vector3{1.0, 1.0, 1.0};
  box.length = turned_about_z({1.0, 0.0, 0.0}, clutter.azimuth_deg * kRadPerDeg);
  return box;
}

Triangle triangle_of(const PlateOptions& plate) {
  const double alpha = plate.alpha_deg * kRadPerDeg;
  const double pitch = plate.pitch_deg * kRadPerDeg;
  const double roll = plate.roll_deg * kRadPerDeg;
  const double c = std::cos(pitch);
  const double s = std::sin(pitch);
  // First rolled about the middle line, then pitched about the base edge's direction.
  const Vector3 along{c, 0.0, s};
  const Vector3 across{-s * std::sin(roll), std::cos(roll), c * std::sin(roll)};
  Triangle triangle;
  triangle.foot =
      turned_about_z({plate.base_distance_mm * kMetre, 0.0, -plate.depth_mm * kMetre}, alpha);
  triangle.along = turned_about_z(along, alpha);
  triangle.across = turned_about_z(across, alpha);
  triangle.half_base_m = 0.5 * plate.hypotenuse_mm * kMetre;
  triangle.reflectivity = plate.reflectivity;
  return triangle;
}

void keep_nearer(std::optional<Hit> hit, int surface, std::optional<Hit>& nearest) {
  if (!hit || (nearest && nearest->distance_m <= hit->distance_m)) return;
  hit->surface = surface;
  nearest = hit;
}

}  // namespace

World::World(const WorldOptions& options) : walls_(walls_of(options.room)) {
  for (const Wall& wall : walls_) {
    if (dot(Vector3{} - wall.point, wall.inward_normal) < 0.2) {
      throw std::invalid_argument(
          "the rig must stand at least 200 mm inside the room: move the walls");
    }
  }
  for (const Furniture& piece : options.room.furniture) {
    boxes_.push_back(box_of(piece, options.room.yaw_deg * kRadPerDeg));
  }
  if (options.ring_clutter.present) {
    boxes_.push_back(clutter_of(options.ring_clutter, options.plate.depth_mm));
  }
  if (options.plate.present) plate_ = triangle_of(options.plate);
}

std::optional<Hit> World::cast(const Ray& ray) const {
  std::optional<Hit> nearest;
  int surface = 0;
  for (const Wall& wall : walls_) keep_nearer(sim::cast(ray, wall), ++surface, nearest);
  for (const Box& box : boxes_) keep_nearer(sim::cast(ray, box), ++surface, nearest);
  if (plate_) keep_nearer(sim::cast(ray, *plate_), ++surface, nearest);
  return nearest;
}

}  // namespace swivel::sim
