#include "calibration/mounting.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "calibration/forward_model.hpp"
#include "tests/calibration/pan_scan.hpp"
#include "tests/calibration/unlike_rig.hpp"

namespace swivel {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kDeg = rad_from_deg(1.0);

void expect_within_sigmas(const MountingFit& fit, const PanScan& scan, double sigmas) {
  const MountingVector truth = true_mounting(scan);
  for (const MountingValue value :
       {kMountingBias, kMountingTilt, kMountingLeverX, kMountingLeverY}) {
    EXPECT_NEAR(fit.solution.value[value], truth[value], sigmas * fit.sigma_of(value)) << value;
  }
}

PanScan unlike_scan() {
  PanScan scan;
  scan.bias_deg = 4.1;
  scan.rx_deg = -0.4;
  scan.ry_deg = 0.5;
  scan.rz_deg = 3.0;
  scan.tx_mm = 12.0;
  scan.ty_mm = -17.0;
  scan.tz_mm = 9.0;
  scan.lines = 40;
  return scan;
}

SweepReadings one_line(double axis_angle_rad, double angle_per_beam_rad, bool down) {
  SweepReadings readings;
  readings.first_beam_angle_rad = -1.1;
  readings.beam_step_rad = 0.3;
  readings.lines.push_back({axis_angle_rad, angle_per_beam_rad, down, {2.0F, 3.0F, 1.0F, 4.0F}});
  return readings;
}

// Distance along a normal at rest, through the forward model that the assembler uses.
double height_by_forward_model(const RigGeometry& rig, const MountingVector& mounting,
                               const SweepReadings& readings, std::size_t beam,
                               const Eigen::Vector3d& normal) {
  RigGeometry mounted = with_mounting(rig, mounting);
  mounted.T_base_axis = Eigen::Isometry3d::Identity();
  const ForwardModel model(mounted, readings.first_beam_angle_rad, readings.beam_step_rad,
                           readings.beams());
  const LineOfReadings& line = readings.lines.front();
  const double angle_rad = line.axis_angle_rad +
                           static_cast<double>(beam) * line.angle_per_beam_rad +
                           (line.turning_down ? mounting[kAxisHysteresis] : 0.0);
  const double range_m = static_cast<double>(line.ranges_m[beam]) - mounting[kRangeOffset];
  return normal.dot(model.point(beam, range_m, angle_rad));
}

TEST(MountedBeams, AreTheForwardModelAndItsDerivatives) {
  const RigGeometry rig = unlike_rig();
  MountingVector mounting = mounting_of(rig);
  mounting[kAxisHysteresis] = 0.02;
  mounting[kRangeOffset] = 0.03;
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.7, 0.5).normalized();
  for (const bool down : {false, true}) {
    const SweepReadings readings = one_line(0.8, 0.01, down);
    const LineOfReadings& line = readings.lines.front();
    const MountedBeams beams(rig, mounting, readings);
    for (std::size_t beam = 0; beam < readings.beams(); ++beam) {
      const ShaftTurn shaft = beams.shaft_at(line, beam);
      const double range_m = line.ranges_m[beam];
      EXPECT_NEAR(normal.dot(shaft.to_rest(beams.turning_point(beam, range_m))),
                  height_by_forward_model(rig, mounting, readings, beam, normal), 1e-12);
      const MountingVector moves = beams.moves_along(shaft.to_turning(normal), line, beam, range_m);
      for (int value = 0; value < kMountingValues; ++value) {
        const MountingVector step = 1e-6 * MountingVector::Unit(value);
        const double slope =
            (height_by_forward_model(rig, mounting + step, readings, beam, normal) -
             height_by_forward_model(rig, mounting - step, readings, beam, normal)) /
            2e-6;
        EXPECT_NEAR(moves[value], slope, 1e-8) << "value " << value << ", beam " << beam;
      }
    }
  }
}

SweepReadings lines_at(const std::vector<double>& up_deg, const std::vector<double>& down_deg) {
  SweepReadings readings;
  for (const double angle_deg : up_deg)
    readings.lines.push_back({angle_deg * kDeg, 0.0, false, {1.0F, 1.0F}});
  for (const double angle_deg : down_deg)
    readings.lines.push_back({angle_deg * kDeg, 0.0, true, {1.0F, 1.0F}});
  return readings;
}

TEST(TwoViews, AreOfWhatBothPassed) {
  constexpr View kFirst = View::kFirst, kSecond = View::kSecond, kOnlyOne = View::kOnlyOne;
  EXPECT_EQ(views_of_lines(lines_at({0, 20, 40, 60}, {61, 50, 30})),
            (std::vector{kOnlyOne, kOnlyOne, kFirst, kFirst, kOnlyOne, kSecond, kSecond}));
  EXPECT_EQ(views_of_lines(lines_at({10, 80, 150, 220, 290}, {})),
            (std::vector{kFirst, kFirst, kOnlyOne, kSecond, kSecond}));
  EXPECT_FALSE(views_of_lines(lines_at({0, 90, 199}, {}))) << "19 deg more than half a turn";
  EXPECT_FALSE(views_of_lines(lines_at({0, 20}, {60, 40})));
  EXPECT_FALSE(views_of_lines({}));
}

TEST(SymmetricRays, FindABiasOf5DegreesUnderARoof) {
  PanScan scan;
  scan.roof_only = true;
  scan.bias_deg = 5.0;
  scan.lines = 60;
  const SymmetricRaysFit fit = fit_symmetric_rays(scan_of(scan), RigGeometry());
  EXPECT_TRUE(fit.verified) << fit.reason;
  EXPECT_EQ(fit.attempts, 1);
  EXPECT_NEAR(fit.bias_rad, 5.0 * kDeg, 0.02 * kDeg);
}

TEST(SymmetricRays, VerificationFindsARoofThatLeansAndTheBiasIsFoundAllTheSame) {
  PanScan scan;
  scan.roof_only = true;
  scan.roof_lean_deg = 1.5;
  scan.start_deg = 77.0;
  scan.bias_deg = -3.0;
  scan.lines = 60;
  const SymmetricRaysFit fit = fit_symmetric_rays(scan_of(scan), RigGeometry());
  EXPECT_TRUE(fit.verified) << fit.reason;
  EXPECT_EQ(fit.attempts, 2);
  EXPECT_NEAR(fit.bias_rad, -3.0 * kDeg, 0.02 * kDeg);
  EXPECT_NEAR(fit.lean_rad, 1.5 * kDeg, 0.05 * kDeg);
}

TEST(Mounting, UnderARoofAloneTheFiveOthersAreNamedAndStay) {
  PanScan scan = unlike_scan();
  scan.roof_only = true;
  RigGeometry nominal;
  nominal.T_axis_lidar.translation() << 0.003, -0.002, 0.05;
  const MountingResult result = fit_mounting(scan_of(scan), nominal);
  ASSERT_TRUE(result.fit) << result.reason;
  EXPECT_THAT(result.fit->unobservable, ElementsAre("ry", "tx", "ty", "rz", "tz"));
  EXPECT_NEAR(result.fit->solution.value[kMountingBias], true_mounting(scan)[kMountingBias],
              0.005 * kDeg);
  EXPECT_LT((result.fit->geometry.T_axis_lidar.matrix() - nominal.T_axis_lidar.matrix()).norm(),
            1e-4);
  EXPECT_THAT(result.fit->advice, HasSubstr("wall"));
}

TEST(Mounting, OfARoomIsFoundWithinItsSigma) {
  const PanScan scan = unlike_scan();
  const MountingResult result = fit_mounting(scan_of(scan), RigGeometry());
  ASSERT_TRUE(result.fit) << result.reason;
  expect_within_sigmas(*result.fit, scan, 4.0);
  EXPECT_LT(result.fit->sigma_of(kMountingBias), 0.005 * kDeg);
  EXPECT_LT(result.fit->sigma_of(kMountingTilt), 0.02 * kDeg);
  EXPECT_LT(result.fit->sigma_of(kMountingLeverX), 0.3e-3);
  EXPECT_THAT(result.fit->unobservable, ElementsAre("rz", "tz"));
  EXPECT_NEAR(result.fit->residual_m, 0.010, 0.0005);
}

TEST(Mounting, OfHalfATurnIsFoundToo) {
  PanScan scan = unlike_scan();
  scan.turn_deg = 180.0;
  scan.bias_deg = 0.9;
  const MountingResult result = fit_mounting(scan_of(scan), RigGeometry());
  ASSERT_TRUE(result.fit) << result.reason;
  EXPECT_FALSE(result.fit->half_scans);
  expect_within_sigmas(*result.fit, scan, 4.0);
}

TEST(Mounting, SweepsUpAndDownShowTheHysteresisOfTheAxis) {
  PanScan up = unlike_scan();
  up.bias_deg = 0.2;
  up.turn_deg = 120.0;
  PanScan down = up;
  down.start_deg = 120.0;
  down.turning_down = true;
  down.hysteresis_deg = 0.1;
  down.seed = 2;
  SweepReadings both = scan_of(up);
  for (const LineOfReadings& line : scan_of(down).lines) both.lines.push_back(line);
  const MountingResult result = fit_mounting(both, RigGeometry());
  ASSERT_TRUE(result.fit) << result.reason;
  const double sigma_rad = result.fit->sigma_of(kAxisHysteresis);
  EXPECT_LT(sigma_rad, 0.02 * kDeg);
  EXPECT_NEAR(result.fit->solution.value[kAxisHysteresis], 0.1 * kDeg, 4.0 * sigma_rad);
}

TEST(Mounting, AsFarOffAsARangeOffsetOfTheLidarStaysRight) {
  PanScan scan = unlike_scan();
  scan.range_offset_mm = 25.0;
  const MountingResult result = fit_mounting(scan_of(scan), RigGeometry());
  ASSERT_TRUE(result.fit) << result.reason;
  expect_within_sigmas(*result.fit, scan, 4.0);
  EXPECT_NEAR(result.fit->solution.value[kRangeOffset], 0.025, 0.002);
}

TEST(Mounting, SweepsOfOneMountingAgreeAndThoseOfTwoDoNot) {
  PanScan scan = unlike_scan();
  scan.lines = 24;
  const MountingResult first = fit_mounting(scan_of(scan), RigGeometry());
  scan.seed = 5;
  scan.start_deg = 20.0;
  const MountingResult again = fit_mounting(scan_of(scan), RigGeometry());
  scan.bias_deg += 0.1;
  const MountingResult other = fit_mounting(scan_of(scan), RigGeometry());
  ASSERT_TRUE(first.fit && again.fit && other.fit);
  const JointMounting joint = join_mountings({*first.fit, *again.fit}, RigGeometry());
  EXPECT_TRUE(joint.scatter.by_chance()) << joint.scatter.sum;
  EXPECT_NEAR(joint.scatter.freedom, 5.0, 1.0) << "four values and the range's offset, twice";
  EXPECT_LT(joint.fit.sigma_of(kMountingBias), 0.8 * first.fit->sigma_of(kMountingBias));
  EXPECT_FALSE(join_mountings({*first.fit, *other.fit}, RigGeometry()).scatter.by_chance());
}

TEST(Mounting, WhatShowsNothingIsRefusedInWords) {
  EXPECT_THAT(fit_mounting({}, RigGeometry()).reason, HasSubstr("0 lines"));
  PanScan scan = unlike_scan();
  scan.lines = 12;
  SweepReadings blind = scan_of(scan);
  for (LineOfReadings& line : blind.lines) {
    for (float& range_m : line.ranges_m) range_m = std::nanf("");
  }
  EXPECT_FALSE(fit_mounting(blind, RigGeometry()).fit);
  for (LineOfReadings& line : blind.lines) {
    for (float& range_m : line.ranges_m) range_m = 0.0F;
  }
  EXPECT_FALSE(fit_mounting(blind, RigGeometry()).fit) << "as close as can be";
  RigGeometry flat;
  flat.T_axis_lidar.linear() =
      Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_THAT(fit_mounting(scan_of(scan), flat).reason, HasSubstr("mounting.rpy_deg"));
}

}  // namespace
}  // namespace swivel
