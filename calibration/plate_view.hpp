// Whether what stands in the ring is the plate, whole and alone. docs/geometry.md (6).
#pragma once

#include <string>
#include <vector>

#include "calibration/attitude.hpp"
#include "calibration/organised_cloud.hpp"
#include "calibration/plate_beams.hpp"
#include "calibration/rig.hpp"

namespace swivel {

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

struct PlateView {
  AttitudeVerdict verdict = AttitudeVerdict::kNoPlate;
  std::string reason;
  double occupancy = 0.0;         // part of the beams on the plate that measured in the ring
  double outline_beta_rad = 0.0;  // where the outline fits best, to half a degree
  double line_step_rad = 0.0;     // azimuth from line to line
};

// What stands at azimuth beta: the plate, whole, or else what is wrong.
PlateView judge_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                      const std::vector<PlateBeam>& beams, double beta_rad);

// What else was seen in the ring, further than the margin from a plate at azimuth beta; empty if
// nothing was.
std::string foreign_object(const PlateGeometry& plate, const std::vector<PlateBeam>& beams,
                           double beta_rad, double margin_m);

}  // namespace swivel
