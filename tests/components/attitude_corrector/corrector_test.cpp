#include "components/attitude_corrector/corrector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "components/common/calibration_file.hpp"
#include "components/common/plate_shape_message.hpp"
#include "components/common/strict_yaml.hpp"
#include "tests/calibration/plate_case.hpp"
#include "tests/calibration/unlike_rig.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

RigFile yuans_rig_file() {
  RigFile rig;
  rig.path = "yuan.yaml";
  rig.geometry = yuans_rig();
  rig.plate = PlateGeometry();
  rig.estimator = "ring_mean";
  return rig;
}

const PlateCase& recorded() {
  static const PlateCase plate_case =
      load_plate_case(std::string(SWIVEL_TEST_DATA) + "/plate_clean_mode1");
  return plate_case;
}

msg::Sweep whole_sweep() {
  msg::Sweep sweep;
  sweep.sweep_id(42);
  sweep.first_beam_time_ns(1'700'000'000'123'456'789);
  sweep.first_device_stamp_ms(77);
  sweep.mode(1);
  sweep.lines_expected(40);
  sweep.complete(true);
  return sweep;
}

msg::Calibration calibration(double alpha_deg, double sigma_deg) {
  msg::Calibration calibration;
  calibration.alpha_deg(alpha_deg);
  calibration.covariance()[kAlpha * kCalibrationSize + kAlpha] = sigma_deg * sigma_deg;
  return calibration;
}

Eigen::Vector3d place(const CloudPoint& point) {
  return Eigen::Vector3f(point.x_m, point.y_m, point.z_m).cast<double>();
}

OrganisedCloud moved(OrganisedCloud cloud, const Eigen::Isometry3d& T_to_from) {
  for (CloudPoint& point : cloud.points) {
    const Eigen::Vector3f there = (T_to_from * place(point)).cast<float>();
    point.x_m = there.x();
    point.y_m = there.y();
    point.z_m = there.z();
  }
  return cloud;
}

void expect_near(const OrganisedCloud& cloud, const OrganisedCloud& expected, double tolerance_m) {
  ASSERT_EQ(cloud.points.size(), expected.points.size());
  for (std::size_t index = 0; index < cloud.points.size(); ++index) {
    ASSERT_EQ(cloud.points[index].valid(), expected.points[index].valid()) << index;
    if (!cloud.points[index].valid()) continue;
    ASSERT_LT((place(cloud.points[index]) - place(expected.points[index])).norm(), tolerance_m);
  }
}

bool same_bits(const OrganisedCloud& one, const OrganisedCloud& other) {
  return one.points.size() == other.points.size() &&
         std::memcmp(one.points.data(), other.points.data(),
                     one.points.size() * sizeof(CloudPoint)) == 0;
}

class CorrectorOn : public testing::TestWithParam<Eigen::Isometry3d> {};

// p_base = T_base_axis * Rz(phi_offset) * p_axis, and p_start = T_base_axis * p_axis.
TEST_P(CorrectorOn, TurnsTheCloudAboutTheAxisWhereverThatStands) {
  RigFile rig = yuans_rig_file();
  rig.geometry.T_base_axis = GetParam();
  Corrector corrector(rig);
  ASSERT_TRUE(
      corrector.set_calibration(calibration(deg_from_rad(recorded().alpha_rad), 0.0)).empty());
  const OrganisedCloud& about_axis = recorded().sweeps[0].cloud;
  OrganisedCloud cloud = moved(about_axis, rig.geometry.T_base_axis);
  const msg::Attitude attitude = corrector.correct(whole_sweep(), cloud);
  ASSERT_EQ(attitude.verdict(), msg::VERDICT_GOOD) << attitude.reason();

  const double error_deg =
      attitude.phi_offset_deg() - deg_from_rad(recorded().sweeps[0].phi_offset_rad);
  EXPECT_LT(std::abs(error_deg), 2.0);
  EXPECT_LT(std::abs(error_deg), 4.0 * attitude.phi_offset_sigma_deg());
  const Eigen::AngleAxisd turn(rad_from_deg(attitude.phi_offset_deg()), Eigen::Vector3d::UnitZ());
  expect_near(cloud, moved(about_axis, rig.geometry.T_base_axis * turn), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(AnyRig, CorrectorOn,
                         testing::Values(Eigen::Isometry3d::Identity(),
                                         unlike_transform(0.0, 0.0, 0.41, 0.0, 0.0, 0.0),
                                         unlike_rig().T_base_axis));

TEST(Corrector, SaysWhatItDid) {
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  const msg::Attitude attitude = Corrector(yuans_rig_file()).correct(whole_sweep(), cloud);
  EXPECT_EQ(attitude.sweep_id(), 42U);
  EXPECT_EQ(attitude.first_beam_time_ns(), 1'700'000'000'123'456'789);
  EXPECT_EQ(attitude.first_device_stamp_ms(), 77U);
  EXPECT_EQ(attitude.mode(), 1);
  EXPECT_EQ(attitude.estimator().to_string(), "ring_mean");
  EXPECT_FALSE(attitude.calibrated());
  EXPECT_DOUBLE_EQ(attitude.alpha_deg(), 30.0);
  EXPECT_NEAR(attitude.phi_offset_deg(), attitude.alpha_deg() - attitude.beta_deg(), 1e-9);
  EXPECT_GT(attitude.points_used(), 300U);
}

TEST(Corrector, ACalibrationMovesPhiOffsetFromTheNextSweepOnAndItsSigmaAddsUp) {
  Corrector corrector(yuans_rig_file());
  OrganisedCloud first = recorded().sweeps[0].cloud, second = first;
  const msg::Attitude drawn = corrector.correct(whole_sweep(), first);
  EXPECT_TRUE(corrector.set_calibration(calibration(28.5, 0.4)).empty());
  const msg::Attitude calibrated = corrector.correct(whole_sweep(), second);
  EXPECT_NEAR(calibrated.phi_offset_deg(), drawn.phi_offset_deg() - 1.5, 1e-9);
  EXPECT_DOUBLE_EQ(calibrated.beta_deg(), drawn.beta_deg());
  EXPECT_TRUE(calibrated.calibrated());
  EXPECT_NEAR(calibrated.phi_offset_sigma_deg(), std::hypot(drawn.beta_sigma_deg(), 0.4), 1e-9);
  EXPECT_GT(drawn.beta_sigma_deg(), 0.0);
}

// Ten degrees lost midway: what was seen after it stands where the shaft was told to be.
OrganisedCloud with_lost_steps(const OrganisedCloud& whole, double lost_deg) {
  const Eigen::AngleAxisd back(rad_from_deg(lost_deg), Eigen::Vector3d::UnitZ());
  const OrganisedCloud turned = moved(whole, Eigen::Isometry3d(back));
  OrganisedCloud cloud = whole;
  const auto half = static_cast<std::ptrdiff_t>(cloud.points.size() / 2);
  std::copy(turned.points.begin() + half, turned.points.end(), cloud.points.begin() + half);
  return cloud;
}

// The plate was seen before the loss: it stands where it should, and knows nothing of it.
TEST(Corrector, ASweepWhoseShaftLostStepsIsNotGoodAndSaysHowMany) {
  OrganisedCloud whole = recorded().sweeps[0].cloud;
  Corrector corrector(yuans_rig_file());
  const msg::Attitude good = corrector.correct(whole_sweep(), whole);
  ASSERT_EQ(good.verdict(), msg::VERDICT_GOOD) << good.reason();
  EXPECT_LT(std::abs(good.seam_deg()), 5.0 * good.seam_sigma_deg());

  OrganisedCloud bent = with_lost_steps(recorded().sweeps[0].cloud, 3.0);
  const OrganisedCloud before = bent;
  const msg::Attitude attitude = corrector.correct(whole_sweep(), bent);
  EXPECT_EQ(attitude.verdict(), msg::VERDICT_SEAM_OPEN) << attitude.reason();
  EXPECT_NEAR(attitude.seam_deg(), -3.0, 0.6);
  EXPECT_THAT(attitude.reason(), HasSubstr("less than said"));
  EXPECT_TRUE(same_bits(bent, before)) << "an uncorrected cloud goes out as it came";
}

TEST(Corrector, ANaiveSweepIsNeverGood) {
  msg::Sweep sweep = whole_sweep();
  sweep.action_sequence(msg::SEQUENCE_NAIVE);
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  const msg::Attitude attitude = Corrector(yuans_rig_file()).correct(sweep, cloud);
  EXPECT_EQ(attitude.verdict(), msg::VERDICT_SEAM_OPEN);
  EXPECT_THAT(attitude.reason(), HasSubstr("naive"));
}

// A plate that was calibrated as tilted by 3 deg, and is not: three sweeps say so, two may be
// chance.
TEST(Corrector, SaysThatACalibrationIsDueWhenThePlateIsNotAsItWas) {
  RigFile rig = yuans_rig_file();
  rig.estimator = "plate_outline";
  for (const double roll_deg : {0.0, 3.0}) {
    LearnedPlate plate;
    plate.shape = PlateShape();
    plate.shape.roll_rad = {rad_from_deg(roll_deg), rad_from_deg(0.05)};
    plate.residual_m = 0.013;
    msg::Calibration known = calibration(30.0, 0.1);
    to_message(plate, known);
    Corrector corrector(rig);
    ASSERT_TRUE(corrector.set_calibration(known).empty());
    for (int sweep = 1; sweep <= 3; ++sweep) {
      OrganisedCloud cloud = recorded().sweeps[0].cloud;
      const msg::Attitude attitude = corrector.correct(whole_sweep(), cloud);
      ASSERT_EQ(attitude.verdict(), msg::VERDICT_GOOD) << attitude.reason();
      EXPECT_EQ(attitude.warning().empty(), sweep < 3 || roll_deg == 0.0) << attitude.warning();
    }
  }
}

TEST(Corrector, ACalibrationOfAnotherLidarIsLeftAsSoonAsThatIsKnown) {
  Corrector corrector(yuans_rig_file());
  msg::Calibration known = calibration(28.5, 0.4);
  known.serial_number("H1");
  ASSERT_TRUE(corrector.set_calibration(known).empty());
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  EXPECT_TRUE(corrector.correct(whole_sweep(), cloud).calibrated());
  EXPECT_THAT(corrector.name_lidar("H2"), HasSubstr("H1"));
  cloud = recorded().sweeps[0].cloud;
  const msg::Attitude attitude = corrector.correct(whole_sweep(), cloud);
  EXPECT_FALSE(attitude.calibrated());
  EXPECT_DOUBLE_EQ(attitude.alpha_deg(), 30.0);
}

TEST(Corrector, ACalibrationThatIsNoNumberIsNotTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Corrector corrector(yuans_rig_file());
  EXPECT_FALSE(corrector.set_calibration(calibration(nan, 0.1)).empty());
  EXPECT_FALSE(corrector.set_calibration(calibration(29.0, nan)).empty());
  msg::Calibration negative = calibration(29.0, 0.1);
  negative.covariance()[0] = -1.0;
  EXPECT_FALSE(corrector.set_calibration(negative).empty());
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  const msg::Attitude attitude = corrector.correct(whole_sweep(), cloud);
  EXPECT_DOUBLE_EQ(attitude.alpha_deg(), 30.0);
  EXPECT_FALSE(attitude.calibrated());
}

TEST(Corrector, WithoutAPlateInSightTheCloudStaysBitForBit) {
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  for (CloudPoint& point : cloud.points) {
    if (std::hypot(point.x_m, point.y_m) < 0.2F) point = {NAN, NAN, NAN, 3.0F};
  }
  const OrganisedCloud before = cloud;
  const msg::Attitude attitude = Corrector(yuans_rig_file()).correct(whole_sweep(), cloud);
  EXPECT_FALSE(Corrector::in_base(attitude.verdict()));
  EXPECT_FALSE(attitude.reason().empty());
  EXPECT_TRUE(std::isnan(attitude.phi_offset_deg()));
  EXPECT_TRUE(std::isnan(attitude.beta_deg()));
  EXPECT_TRUE(same_bits(cloud, before));
}

TEST(Corrector, AnEmptyCloudIsNoPlate) {
  OrganisedCloud nothing, no_beams;
  no_beams.lines = 5;
  EXPECT_FALSE(
      Corrector::in_base(Corrector(yuans_rig_file()).correct(whole_sweep(), nothing).verdict()));
  EXPECT_FALSE(
      Corrector::in_base(Corrector(yuans_rig_file()).correct(whole_sweep(), no_beams).verdict()));
}

TEST(Corrector, AGapElsewhereIsTold) {
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  msg::Sweep sweep = whole_sweep();
  sweep.complete(false);
  sweep.lines_missing(3);
  sweep.reason("3 of 40 lines missing");
  const msg::Attitude attitude = Corrector(yuans_rig_file()).correct(sweep, cloud);
  EXPECT_EQ(attitude.lines_missing(), 3U);
  EXPECT_THAT(attitude.reason(), HasSubstr("3 of 40 lines missing"));
}

TEST(Corrector, AMeasuredRigPassesThroughBitForBit) {
  RigFile rig = yuans_rig_file();
  rig.axis_measured = true;
  rig.plate.reset();
  OrganisedCloud cloud = recorded().sweeps[0].cloud;
  const OrganisedCloud before = cloud;
  const msg::Attitude attitude = Corrector(rig).correct(whole_sweep(), cloud);
  EXPECT_EQ(attitude.verdict(), msg::VERDICT_MEASURED);
  EXPECT_TRUE(Corrector::in_base(attitude.verdict()));
  EXPECT_EQ(attitude.phi_offset_deg(), 0.0);
  EXPECT_TRUE(same_bits(cloud, before));
}

TEST(Corrector, CannotStartWithoutWhatItNeeds) {
  RigFile unknown = yuans_rig_file();
  unknown.estimator = "tea_leaves";
  RigFile no_plate = yuans_rig_file();
  no_plate.plate.reset();
  const auto reason = [](const RigFile& rig) -> std::string {
    try {
      Corrector corrector(rig);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(reason(unknown), HasSubstr("tea_leaves"));
  EXPECT_THAT(reason(unknown), HasSubstr("yuan.yaml"));
  EXPECT_THAT(reason(no_plate), HasSubstr("plate"));
  EXPECT_EQ(reason(yuans_rig_file()), "");
}

}  // namespace
}  // namespace swivel
