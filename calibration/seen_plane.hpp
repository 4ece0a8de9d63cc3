// PCL's plane for RANSAC, of the points whose beams see it. docs/geometry.md (8).
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <algorithm>
#include <cmath>

namespace swivel {

// From the origin, the points of a plane that are seen at more than a grazing angle, wherever on
// its lever arm the lidar was. Lines near to one another lie on the scan plane, whatever they met,
// but no surface is seen along itself.
inline double furthest_seen_m(double distance_m, double lever_arm_m) {
  constexpr double kSineOfGrazing = 0.1;  // of the angle between beam and plane
  return std::max(0.0, distance_m - lever_arm_m) / kSineOfGrazing;
}

class SeenPlane : public pcl::SampleConsensusModelPlane<pcl::PointXYZ> {
 public:
  SeenPlane(const PointCloudConstPtr& cloud, double lever_arm_m)
      : SampleConsensusModelPlane(cloud), lever_arm_m_(lever_arm_m) {}

  std::size_t countWithinDistance(const Eigen::VectorXf& plane, double band_m) const override {
    const Seen seen(plane, band_m, lever_arm_m_);
    return static_cast<std::size_t>(std::count_if(input_->begin(), input_->end(), seen));
  }

  void selectWithinDistance(const Eigen::VectorXf& plane, double band_m,
                            pcl::Indices& selected) override {
    const Seen seen(plane, band_m, lever_arm_m_);
    selected.clear();
    for (const pcl::index_t index : *indices_) {
      if (seen((*input_)[static_cast<std::size_t>(index)])) selected.push_back(index);
    }
  }

 private:
  class Seen {
   public:
    Seen(const Eigen::VectorXf& plane, double band_m, double lever_arm_m)
        : plane_(plane.head<4>()),
          band_m_(static_cast<float>(band_m)),
          furthest_m_(static_cast<float>(
              furthest_seen_m(static_cast<double>(std::abs(plane[3])), lever_arm_m))) {}

    bool operator()(const pcl::PointXYZ& point) const {
      const auto place = point.getVector3fMap();
      return std::abs(plane_.head<3>().dot(place) + plane_[3]) <= band_m_ &&
             place.squaredNorm() <= furthest_m_ * furthest_m_;
    }

   private:
    Eigen::Vector4f plane_;
    float band_m_;
    float furthest_m_;
  };

  double lever_arm_m_;
};

}  // namespace swivel
