// The room, its furniture, and the plate on the rig.
#pragma once

#include <optional>
#include <vector>

#include "hardware/sim/surfaces.hpp"

namespace swivel::sim {

// A box of furniture, in the room's frame (which is O turned by the room's yaw).
struct Furniture {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double yaw_deg = 0.0;
  double length_mm = 100.0;  // along its own x
  double width_mm = 100.0;
  double bottom_mm = 0.0;
  double top_mm = 100.0;
  double reflectivity = 0.4;
};

struct RoomOptions {
  double front_mm = 3400.0;  // where the walls stand along the room's X and Y
  double back_mm = -2600.0;
  double left_mm = 2400.0;
  double right_mm = -2100.0;
  double floor_mm = -950.0;
  double roof_mm = 1850.0;
  double yaw_deg = 0.0;         // of the room against the rig's front
  double front_skew_deg = 0.0;  // of the front wall against the rest of the room
  std::vector<Furniture> furniture = {
      {2600.0, 1500.0, 12.0, 800.0, 1600.0, -950.0, -210.0, 0.35},  // a table
      {-2250.0, -1200.0, 0.0, 450.0, 1200.0, -950.0, 850.0, 0.6},   // a cupboard
      {900.0, -1650.0, -25.0, 450.0, 450.0, -950.0, -480.0, 0.25},  // a stool
  };
};

// Yuan 2021, section 4.1. The plate stands still: it is fixed to the base, not to the shaft.
struct PlateOptions {
  bool present = true;
  double alpha_deg = 29.36;  // azimuth of its middle line in O; 30 is drawn
  double base_distance_mm = 54.75;
  double hypotenuse_mm = 112.0;
  double depth_mm = 60.935;  // below the lidar's centre
  double pitch_deg = 0.0;    // lifts the right angle
  double roll_deg = 0.0;     // lifts the left end of the base edge
  double reflectivity = 0.7;
};

// A cable or a tool left in the ring in which only the plate may be.
struct ClutterOptions {
  bool present = false;
  double azimuth_deg = 75.0;
  double distance_mm = 90.0;
  double size_mm = 20.0;
};

struct WorldOptions {
  RoomOptions room;
  PlateOptions plate;
  ClutterOptions ring_clutter;
};

class World {
 public:
  // Throws std::invalid_argument when the rig would not stand inside the room.
  explicit World(const WorldOptions& options);

  // The nearest surface; nothing when the ray leaves the world.
  std::optional<Hit> cast(const Ray& ray) const;

 private:
  std::vector<Wall> walls_;
  std::vector<Box> boxes_;
  std::optional<Triangle> plate_;
};

}  // namespace swivel::sim
