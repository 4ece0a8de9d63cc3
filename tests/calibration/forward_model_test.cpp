#include "calibration/forward_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/calibration/unlike_rig.hpp"

namespace swivel {
namespace {

TEST(ForwardModel, IsYuansEquations4To6OnHisRig) {
  RigGeometry rig;
  rig.T_axis_lidar.translation() << 0.0139, 0.0, 0.0;
  const ForwardModel model(rig, rad_from_deg(-135.0), rad_from_deg(0.25), 1081);
  for (const std::size_t beam : {0U, 137U, 540U, 902U, 1080U}) {
    const double theta = (static_cast<double>(beam) * 0.25 - 135.0) * M_PI / 180.0;
    for (const double phi : {-0.7, 0.0, 1.3, 3.0}) {
      const double r = 2.7;
      const double x = 0.0139;
      const double y = r * std::sin(theta);
      const Eigen::Vector3d expected(std::cos(phi) * x - std::sin(phi) * y,
                                     std::sin(phi) * x + std::cos(phi) * y, r * std::cos(theta));
      EXPECT_LT((model.point(beam, r, phi) - expected).norm(), 1e-14);
    }
  }
}

// Worked by hand with numbers that are all unlike: T_axis_lidar turns L by +90 deg about Z and
// shifts it by (1, 2, 3); the axis turns by +90 deg; T_base_axis turns by +90 deg about X and
// shifts by (10, 20, 30). The beam points along L's Y (theta + bias = 90 deg), 5 m away.
TEST(ForwardModel, ComposesMountingTurnAndTiltOfTheAxisInThisOrder) {
  RigGeometry rig;
  rig.T_axis_lidar = Eigen::Translation3d(1, 2, 3) *
                     Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitZ());
  rig.T_base_axis = Eigen::Translation3d(10, 20, 30) *
                    Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitX());
  rig.bias_rad = rad_from_deg(20.0);
  const ForwardModel model(rig, rad_from_deg(60.0), rad_from_deg(5.0), 3);
  // L (0,5,0) -> axis (-5,0,0) + (1,2,3) = (-4,2,3) -> turned (-2,-4,3) -> base (-2,-3,-4) + t
  EXPECT_LT((model.point(2, 5.0, rad_from_deg(90.0)) - Eigen::Vector3d(8, 17, 26)).norm(), 1e-12);
}

TEST(ForwardModel, TheBiasIsABeamsShift) {
  RigGeometry straight = unlike_rig();
  RigGeometry biased = straight;
  biased.bias_rad += rad_from_deg(0.75);
  const ForwardModel without(straight, rad_from_deg(-135.0), rad_from_deg(0.25), 1081);
  const ForwardModel with(biased, rad_from_deg(-135.0), rad_from_deg(0.25), 1081);
  EXPECT_LT((with.point(400, 3.0, 0.4) - without.point(403, 3.0, 0.4)).norm(), 1e-12);
}

TEST(ForwardModel, ADoublesRangeIsLinear) {
  const ForwardModel model(unlike_rig(), rad_from_deg(-135.0), rad_from_deg(0.25), 1081);
  const Eigen::Vector3d near = model.point(77, 1.0, 0.9);
  const Eigen::Vector3d middle = model.point(77, 2.0, 0.9);
  const Eigen::Vector3d far = model.point(77, 3.0, 0.9);
  EXPECT_LT((near + far - 2.0 * middle).norm(), 1e-12);
  EXPECT_NEAR((far - near).norm(), 2.0, 1e-12);
}

}  // namespace
}  // namespace swivel
