// A whole scan line through the forward model, fast: each beam at its own axis angle.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "calibration/forward_model.hpp"
#include "calibration/organised_cloud.hpp"

namespace swivel {

// What the sensor said in one line. Ranges outside [range_min_mm, range_max_mm], and with them
// the sensor's codes, are no points.
struct LineReadings {
  const std::vector<std::uint16_t>& ranges_mm;
  const std::vector<std::uint16_t>& intensities;  // empty, or one a beam
  std::uint16_t range_min_mm = 0;
  std::uint16_t range_max_mm = 0;
};

class LineAssembler {
 public:
  explicit LineAssembler(const ForwardModel& model);

  // Writes model().beam_count() points to row: beam k at axis angle
  // axis_angle_rad + k * angle_per_beam_rad. An invalid beam is NaN with its intensity; without
  // intensities that is 0. Within 3e-7 of the range of ForwardModel::point, which is the rounding
  // to float: 3 um at 10 m, where the sensor says millimetres.
  // Quick as long as angle_per_beam_rad stays what it was, as it does within a sweep.
  void assemble(const LineReadings& readings, double axis_angle_rad, double angle_per_beam_rad,
                CloudPoint* row);

  // The same with an axis angle for each beam, whatever the axis did.
  void assemble(const LineReadings& readings, const std::vector<double>& axis_angles_rad,
                CloudPoint* row);

  const ForwardModel& model() const { return model_; }

 private:
  void turn_beams(double angle_per_beam_rad);
  void read_line(const LineReadings& readings);
  void project(const Eigen::Matrix3d& R_base_turned, CloudPoint* row) const;

  ForwardModel model_;
  double tolerance_rad_;  // of angle per beam, before the beams are turned again
  double angle_per_beam_rad_;
  // Beam k's direction and the lever arm, already turned by k * angle_per_beam_rad_; a row each
  // of x, y, z, so that the compiler can take several beams at a time.
  Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor> directions_;
  Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor> lever_arms_m_;
  std::vector<float> ranges_m_;     // of the line in work; NaN where invalid
  std::vector<float> intensities_;  // of the line in work
};

}  // namespace swivel
