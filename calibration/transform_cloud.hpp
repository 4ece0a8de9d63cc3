// A cloud into another frame.
#pragma once

#include <Eigen/Geometry>

#include "calibration/organised_cloud.hpp"

namespace swivel {

// In place; intensities and what is invalid stay as they are.
void transform_cloud(const Eigen::Isometry3d& T_to_from, OrganisedCloud& cloud);

}  // namespace swivel
