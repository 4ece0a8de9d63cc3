#include "calibration/transform_cloud.hpp"

namespace swivel {

void transform_cloud(const Eigen::Isometry3d& T_to_from, OrganisedCloud& cloud) {
  const Eigen::Matrix3f R = T_to_from.linear().cast<float>();
  const Eigen::Vector3f t_m = T_to_from.translation().cast<float>();
  for (CloudPoint& point : cloud.points) {
    const Eigen::Vector3f moved_m = R * Eigen::Vector3f(point.x_m, point.y_m, point.z_m) + t_m;
    point.x_m = moved_m.x();
    point.y_m = moved_m.y();
    point.z_m = moved_m.z();
  }
}

AlongAxis::AlongAxis(const OrganisedCloud& cloud, const RigGeometry& rig) : original_(cloud) {
  if (rig.T_base_axis.isApprox(Eigen::Isometry3d::Identity())) return;
  moved_ = cloud;
  transform_cloud(rig.T_base_axis.inverse(), *moved_);
}

}  // namespace swivel
