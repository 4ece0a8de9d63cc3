// The beams that meet the plate's plane near the plate, whatever they did measure.
//
// A range is noisy, a direction is not: following each beam from the lidar's centre to the plate's
// plane gives where it would meet the plate. So the outline is sharp.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "calibration/organised_cloud.hpp"
#include "calibration/rig.hpp"

namespace swivel {

// A beam that meets the drawn plane of the plate inside the half ring. docs/geometry.md (6).
struct PlateBeam {
  double x_m = 0.0;  // where it meets the plane, in O'
  double y_m = 0.0;
  double slope_x = 0.0;  // by how much that place moves when the plane is higher
  double slope_y = 0.0;
  double azimuth_rad = 0.0;
  double beyond_m = 0.0;  // measured range less the range of that place
  std::uint32_t line = 0;
  bool in_ring = false;  // the point that it measured lies in the ring

  // By how much the range of that place changes when the plane is higher.
  double range_per_height() const {
    return -std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
  }
};

// Takes the raw cloud in O', its Z the axis of rotation. Beams without a return are not there.
std::vector<PlateBeam> beams_at_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                      const RigGeometry& rig);

// Yuan's cut: the half ring on X' > 0 about the plate's plane.
bool in_ring(const CloudPoint& point, const PlateGeometry& plate, double height_m);

// The height of the plate's plane in O'.
double plate_height_m(const PlateGeometry& plate, const RigGeometry& rig);

}  // namespace swivel
