// What is promised of the mounting's sigma and of the roof, over several rigs and two rooms. In
// release alone: the sanitizers see the same code in calibration_test.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "calibration/forward_model.hpp"
#include "calibration/mounting.hpp"
#include "hardware/sim/random.hpp"
#include "tests/calibration/pan_scan.hpp"

namespace swivel {
namespace {

constexpr double kDeg = rad_from_deg(1.0);

sim::RoomOptions some_room(std::uint64_t seed) {
  sim::RoomOptions room;
  if (seed % 2 == 0) return room;
  room.furniture.clear();
  room.yaw_deg = 25.0;
  room.front_mm = 5200.0;
  return room;
}

PanScan some_scan(std::uint64_t seed) {
  sim::Random random(seed, 11);
  PanScan scan;
  scan.seed = seed;
  scan.lines = 40;
  scan.bias_deg = random.uniform(-5.0, 5.0);
  scan.ry_deg = random.uniform(-0.6, 0.6);
  scan.tx_mm = random.uniform(-30.0, 30.0);
  scan.ty_mm = random.uniform(-30.0, 30.0);
  scan.room = some_room(seed);
  return scan;
}

TEST(MountingAccuracy, SigmasAreHonest) {
  constexpr std::uint64_t kRuns = 10;
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const PanScan scan = some_scan(seed);
    const MountingResult result = fit_mounting(scan_of(scan), RigGeometry());
    ASSERT_TRUE(result.fit) << result.reason;
    const std::array<double, 4> truth{scan.bias_deg * kDeg, scan.ry_deg * kDeg, 1e-3 * scan.tx_mm,
                                      1e-3 * scan.ty_mm};
    for (const MountingValue value :
         {kMountingBias, kMountingTilt, kMountingLeverX, kMountingLeverY}) {
      const double off = result.fit->solution.value[value] - truth.at(value);
      squares += std::pow(off / result.fit->sigma_of(value), 2);
    }
  }
  const double rms = std::sqrt(squares / (4.0 * kRuns));
  EXPECT_GT(rms, 0.75);
  EXPECT_LT(rms, 1.25);
}

// Mean distance from their own plane of the rays that meet the roof for certain.
double mean_roof_deviation_mm(const RigGeometry& rig, const SweepReadings& readings) {
  const ForwardModel model(rig, readings.first_beam_angle_rad, readings.beam_step_rad,
                           readings.beams());
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const LineOfReadings& line : readings.lines) {
    for (std::size_t beam = 400; beam <= 680; ++beam) {
      points.push_back(
          model.point(beam, static_cast<double>(line.ranges_m[beam]), line.axis_angle_rad));
      mean += points.back();
    }
  }
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
    scatter += (point - mean) * (point - mean).transpose();
  const Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  double sum_m = 0.0;
  for (const Eigen::Vector3d& point : points) sum_m += std::abs(normal.dot(point - mean));
  return 1e3 * sum_m / static_cast<double>(points.size());
}

TEST(MountingAccuracy, TheRoofIsAsFlatAsTheNoiseLeavesIt) {
  PanScan scan;
  scan.bias_deg = 3.75;
  scan.lines = 90;
  for (const std::uint64_t seed : {1U, 2U}) {
    scan.room = some_room(seed);
    const SweepReadings readings = scan_of(scan);
    RigGeometry truth;
    truth.bias_rad = scan.bias_deg * kDeg;
    const MountingResult result = fit_mounting(readings, RigGeometry());
    ASSERT_TRUE(result.fit) << result.reason;
    EXPECT_NEAR(result.fit->solution.value[kMountingBias], truth.bias_rad, 0.005 * kDeg);
    const double noise_mm = mean_roof_deviation_mm(truth, readings);
    EXPECT_GT(mean_roof_deviation_mm(RigGeometry(), readings), 4.0 * noise_mm);
    EXPECT_NEAR(mean_roof_deviation_mm(result.fit->geometry, readings), noise_mm, 0.03 * noise_mm);
  }
}

}  // namespace
}  // namespace swivel
