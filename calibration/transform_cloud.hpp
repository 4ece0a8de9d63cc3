// A cloud into another frame.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "calibration/organised_cloud.hpp"
#include "calibration/rig.hpp"

namespace swivel {

// In place; intensities and what is invalid stay as they are.
void transform_cloud(const Eigen::Isometry3d& T_to_from, OrganisedCloud& cloud);

// A cloud in the frame of the axis at angle 0, wherever the axis stands in the base: itself, or a
// moved copy. The cloud given must outlive it.
class AlongAxis {
 public:
  AlongAxis(const OrganisedCloud& cloud, const RigGeometry& rig);
  const OrganisedCloud& cloud() const { return moved_ ? *moved_ : original_; }

 private:
  const OrganisedCloud& original_;
  std::optional<OrganisedCloud> moved_;
};

}  // namespace swivel
