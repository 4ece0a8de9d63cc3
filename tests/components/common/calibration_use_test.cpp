#include "components/common/calibration_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "components/common/calibration_file.hpp"
#include "tests/calibration/unlike_rig.hpp"

namespace swivel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

double& variance(msg::Calibration& calibration, std::size_t index) {
  return calibration.covariance()[index * kCalibrationSize + index];
}

msg::Calibration of_alpha(const std::string& serial_number = "H1") {
  msg::Calibration calibration;
  calibration.rig("swivel");
  calibration.alpha_deg(29.3);
  calibration.serial_number(serial_number);
  variance(calibration, kAlpha) = 0.01;
  return calibration;
}

msg::Calibration of_mounting(const std::string& serial_number = "H1") {
  msg::Calibration calibration;
  calibration.rig("swivel");
  calibration.serial_number(serial_number);
  set_mounting(unlike_rig(), calibration);
  variance(calibration, kBias) = 1e-6;
  return calibration;
}

// Three turns and three shifts, no two alike, there and back.
TEST(CalibrationUse, AMountingComesOutAsItWentIn) {
  RigGeometry drawn;
  drawn.T_base_axis.translation() = Eigen::Vector3d(1, 2, 3);
  const RigGeometry told = calibrated_geometry(drawn, of_mounting());
  EXPECT_LT((told.T_axis_lidar.matrix() - unlike_rig().T_axis_lidar.matrix()).norm(), 1e-12);
  EXPECT_NEAR(told.bias_rad, unlike_rig().bias_rad, 1e-15);
  EXPECT_NEAR(told.hysteresis_rad, unlike_rig().hysteresis_rad, 1e-15);
  EXPECT_EQ(told.T_base_axis.matrix(), drawn.T_base_axis.matrix());
}

// Turns about the fixed X, then Y, then Z: x goes to y by a quarter turn about Z, and so on.
TEST(CalibrationUse, TurnsAreThoseOfTheRigFile) {
  const Eigen::Isometry3d T = transform_of({1, 2, 3}, {90, 0, 90});
  EXPECT_LT((T * Eigen::Vector3d::UnitZ() - Eigen::Vector3d(1.001, 0.002, 0.003)).norm(), 1e-12);
  EXPECT_LT((T * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0.001, 1.002, 0.003)).norm(), 1e-12);
  EXPECT_LT((rpy_deg_of(T.linear()) - Eigen::Vector3d(90, 0, 90)).norm(), 1e-9);
}

TEST(CalibrationUse, WhatWasNotEstimatedStaysAsDrawn) {
  const RigGeometry drawn = unlike_rig();
  EXPECT_EQ(calibrated_geometry(drawn, of_alpha()).T_axis_lidar.matrix(),
            drawn.T_axis_lidar.matrix());
  EXPECT_EQ(calibrated_geometry(drawn, of_alpha()).bias_rad, drawn.bias_rad);
  EXPECT_TRUE(tells_alpha(of_alpha()));
  EXPECT_FALSE(tells_mounting(of_alpha()));
  EXPECT_FALSE(tells_alpha(of_mounting()));
  EXPECT_TRUE(tells_mounting(of_mounting()));
  EXPECT_TRUE(tells_alpha(msg::Calibration()));  // a file from before there were variances
}

TEST(CalibrationUse, AlphaKeepsTheMountingItWasFoundWithAndNotTheOtherWayRound) {
  const msg::Calibration both = completed(of_alpha(), of_mounting());
  EXPECT_TRUE(tells_alpha(both) && tells_mounting(both));
  EXPECT_EQ(both.alpha_deg(), 29.3);
  EXPECT_EQ(both.bias_deg(), of_mounting().bias_deg());
  EXPECT_EQ(both.mounting_rpy_deg(), of_mounting().mounting_rpy_deg());
  EXPECT_FALSE(tells_alpha(completed(of_mounting(), of_alpha())));
  EXPECT_FALSE(tells_mounting(completed(of_alpha("H2"), of_mounting("H1"))));
  EXPECT_FALSE(tells_mounting(completed(of_alpha(), std::nullopt)));
}

TEST(CalibrationInUse, IsThatOfThisRigAndThisLidarAlone) {
  CalibrationInUse use("swivel");
  EXPECT_FALSE(use.now());
  EXPECT_THAT(use.name_lidar("H1"), IsEmpty());
  EXPECT_THAT(use.take(of_mounting("H1")), IsEmpty());
  ASSERT_TRUE(use.now());
  EXPECT_THAT(use.take(of_alpha("H2")), HasSubstr("H2"));
  EXPECT_TRUE(tells_mounting(*use.now()));  // the one before goes on
  msg::Calibration other = of_alpha();
  other.rig("zeng");
  EXPECT_THAT(use.take(other), HasSubstr("'zeng'"));
  EXPECT_TRUE(tells_mounting(*use.now()));
}

TEST(CalibrationInUse, FollowsTheLidarThatScans) {
  CalibrationInUse use("swivel");
  EXPECT_THAT(use.take(of_alpha("H1")), IsEmpty());  // the lidar is not known yet
  EXPECT_TRUE(use.now());
  EXPECT_THAT(use.name_lidar("H2"), HasSubstr("H1"));
  EXPECT_FALSE(use.now());
  EXPECT_THAT(use.name_lidar("H2"), IsEmpty());  // said once
  EXPECT_FALSE(use.now());
  EXPECT_THAT(use.name_lidar("H1"), IsEmpty());
  EXPECT_TRUE(use.now());
}

TEST(CalibrationInUse, RefusesWhatIsNoNumber) {
  CalibrationInUse use("swivel");
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    msg::Calibration calibration = of_mounting();
    calibration.mounting_rpy_deg()[1] = wrong;
    EXPECT_THAT(use.take(calibration), HasSubstr("not a number"));
  }
  msg::Calibration negative = of_mounting();
  variance(negative, kYaw) = -1.0;
  EXPECT_THAT(use.take(negative), HasSubstr("variance"));
  EXPECT_FALSE(use.now());
}

TEST(CalibrationInUse, TheLidarIsThatOfTheReader) {
  msg::Health health;
  msg::Fact fact;
  fact.name("serial_number");
  fact.value("H7");
  health.facts().push_back(fact);
  health.participant("other");
  EXPECT_FALSE(lidar_serial_number(health));
  health.participant("hokuyo_reader");
  EXPECT_EQ(lidar_serial_number(health), "H7");
}

}  // namespace
}  // namespace swivel
