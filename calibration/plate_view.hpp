// The beams that meet the plate's plane near the plate, and whether what they saw is the plate.
//
// A range is noisy, a direction is not: following each beam from the lidar's centre to the plate's
// plane gives where it would meet the plate, whatever it did meet. So the outline is sharp.
#pragma once

#include <string>
#include <vector>

#include "calibration/attitude.hpp"
#include "calibration/organised_cloud.hpp"
#include "calibration/rig.hpp"

namespace swivel {

// A beam that meets the plate's plane inside the half ring.
struct PlateBeam {
  double x_m = 0.0;  // where it meets the plane, in O'
  double y_m = 0.0;
  double azimuth_rad = 0.0;
  std::size_t line = 0;
  bool in_ring = false;  // the point that it measured lies in the ring
};

// docs/geometry.md (6).
std::vector<PlateBeam> beams_at_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                      const RigGeometry& rig);

// The triangle that a plate at azimuth beta covers, seen from above.
class PlateOutline {
 public:
  PlateOutline(const PlateGeometry& plate, double beta_rad);

  // How far a place lies inside; negative outside.
  double inside_m(double x_m, double y_m) const;

 private:
  PlateGeometry plate_;
  double cos_beta_;
  double sin_beta_;
};

// Yuan's cut: the half ring on X' > 0 about the plate's plane.
bool in_ring(const CloudPoint& point, const PlateGeometry& plate, double height_m);

// The height of the plate's plane in O'.
double plate_height_m(const PlateGeometry& plate, const RigGeometry& rig);

struct PlateView {
  AttitudeVerdict verdict = AttitudeVerdict::kNoPlate;
  std::string reason;
  double occupancy = 0.0;         // part of the beams on the plate that measured in the ring
  double outline_beta_rad = 0.0;  // where the outline fits best, to half a degree
  double line_step_rad = 0.0;     // azimuth from line to line
};

// What stands at azimuth beta: the plate, whole and alone, or else what is wrong.
PlateView judge_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                      const std::vector<PlateBeam>& beams, double beta_rad);

}  // namespace swivel
