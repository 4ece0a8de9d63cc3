#include "calibration/forward_model.hpp"

#include <cassert>

namespace swivel {

ForwardModel::ForwardModel(const RigGeometry& rig, double first_beam_angle_rad,
                           double beam_step_rad, std::size_t beam_count)
    : rig_(rig),
      first_beam_angle_rad_(first_beam_angle_rad),
      beam_step_rad_(beam_step_rad),
      beam_count_(beam_count) {}

double ForwardModel::beam_angle_rad(std::size_t beam) const {
  return first_beam_angle_rad_ + static_cast<double>(beam) * beam_step_rad_ + rig_.bias_rad;
}

Eigen::Vector3d ForwardModel::point(std::size_t beam, double range_m, double axis_angle_rad) const {
  assert(beam < beam_count_);
  return point_in_base(rig_.T_base_axis, axis_angle_rad, rig_.T_axis_lidar, beam_angle_rad(beam),
                       range_m);
}

}  // namespace swivel
