#include "components/swivel/report/evaluation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/transform_cloud.hpp"
#include "components/swivel/report/surfaces.hpp"

namespace swivel {
namespace {

constexpr double kNoise_m = 0.012;

// A room of four walls, square to the axes, with a floor that is seen more: 2.1 m to the right, 3.4
// m ahead, ...
OrganisedCloud room() {
  OrganisedCloud cloud(200, 400);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, kNoise_m);
  for (CloudPoint& measured : cloud.points) {
    const double x = -2.6 + 6.0 * part(random), y = -2.1 + 4.5 * part(random);
    const double z = -0.9 + 2.5 * part(random);
    const Eigen::Vector3d points[] = {{x, -2.1 + noise(random), z},
                                      {3.4 + noise(random), y, z},
                                      {x, 2.4 + noise(random), z},
                                      {-2.6 + noise(random), y, z},
                                      {x, y, -0.95 + noise(random)}};
    const Eigen::Vector3f point = points[std::min<std::size_t>(random() % 6, 4)].cast<float>();
    measured = {point.x(), point.y(), point.z(), 1.0F};
  }
  return cloud;
}

OrganisedCloud room_turned(double angle_rad) {
  OrganisedCloud cloud = room();
  transform_cloud(Eigen::Isometry3d(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ())), cloud);
  return cloud;
}

std::vector<Plane> walls_of(const OrganisedCloud& cloud) {
  std::vector<Plane> planes;
  for (const Surface& surface : find_surfaces(cloud, SurfaceKind::kUpright))
    planes.push_back(surface.plane);
  return planes;
}

SweepAttitude corrected_by(double phi_offset_rad, std::size_t sweep = 0) {
  SweepAttitude attitude;
  attitude.sweep = sweep;
  attitude.mode = 1;
  attitude.corrected = true;
  attitude.phi_offset_rad = phi_offset_rad;
  return attitude;
}

TEST(MapError, IsDistanceTimesTangentAndStaysInItsBandAsFarAsIsSaid) {
  for (const double error_deg : {0.3, 1.2456, 5.0}) {
    const double error_rad = rad_from_deg(error_deg);
    for (const double distance_m : {0.5, 3.0, 10.0})
      EXPECT_DOUBLE_EQ(map_error_m(distance_m, error_rad), distance_m * std::tan(error_rad));
    EXPECT_NEAR(std::abs(map_error_m(kept_up_to_m(-error_rad), error_rad)), 0.050, 1e-12);
  }
  EXPECT_EQ(kept_up_to_m(0.0), 10.0) << "the lidar's reach is the end of it";
  EXPECT_EQ(kept_up_to_m(rad_from_deg(0.2)), 10.0);
  EXPECT_TRUE(std::isnan(kept_up_to_m(kUnknownAngle)));
}

TEST(MapError, IsThePapersForThePapersErrors) {
  EXPECT_NEAR(kept_up_to_m(*papers_largest_rad(1)), 2.2996, 1e-4);
  EXPECT_NEAR(kept_up_to_m(*papers_largest_rad(7)), 10.0, 0.001) << "as rounded there";
}

TEST(PhiError, OfACloudTurnedByAKnownAngleIsThatAngleClockwise) {
  for (const double turned_deg : {-3.0, 0.4, 7.0}) {
    const double turned_rad = rad_from_deg(turned_deg);
    std::vector<SweepAttitude> alone{corrected_by(rad_from_deg(2.0))};
    const Reference reference = judge_by_walls({walls_of(room_turned(turned_rad))}, 0.0, alone);
    EXPECT_EQ(reference, Reference::kSquareWalls);
    EXPECT_NEAR(deg_from_rad(alone[0].with_rad), -turned_deg, 0.02);
    EXPECT_NEAR(deg_from_rad(alone[0].without_rad), 2.0 - turned_deg, 0.02) << "before its turn";
  }
}

TEST(PhiError, TurnsTheCloudRight) {
  const double turned_rad = rad_from_deg(2.5);
  std::vector<SweepAttitude> alone{corrected_by(0.0)};
  judge_by_walls({walls_of(room_turned(turned_rad))}, 0.0, alone);
  OrganisedCloud cloud = room_turned(turned_rad);
  transform_cloud(Eigen::Isometry3d(Eigen::AngleAxisd(alone[0].with_rad, Eigen::Vector3d::UnitZ())),
                  cloud);
  EXPECT_NEAR(*turned_from_square_rad(walls_of(cloud), 0.0), 0.0, rad_from_deg(0.02));
}

TEST(PhiError, OfSeveralSweepsIsAgainstTheirMedianHoweverTheRigStands) {
  const double standing_rad = rad_from_deg(31.0);  // no square direction near
  std::vector<std::vector<Plane>> walls;
  std::vector<SweepAttitude> sweeps;
  for (const double turned_deg : {0.0, 0.5, -1.0}) {
    walls.push_back(walls_of(room_turned(standing_rad + rad_from_deg(turned_deg))));
    sweeps.push_back(corrected_by(0.0, sweeps.size()));
  }
  EXPECT_EQ(judge_by_walls(walls, 0.0, sweeps), Reference::kOtherSweeps);
  EXPECT_NEAR(deg_from_rad(sweeps[0].with_rad), 0.0, 0.02);
  EXPECT_NEAR(deg_from_rad(sweeps[1].with_rad), -0.5, 0.02);
  EXPECT_NEAR(deg_from_rad(sweeps[2].with_rad), 1.0, 0.02);
}

TEST(PhiError, OfASweepWithoutAttitudeIsNeverOneWithCorrection) {
  SweepAttitude refused;
  judge_by_start(0.1, refused);
  EXPECT_DOUBLE_EQ(refused.without_rad, 0.1);
  EXPECT_TRUE(std::isnan(refused.with_rad));
  judge_by_walls(0.2, refused);
  EXPECT_DOUBLE_EQ(refused.without_rad, -0.2);
  EXPECT_TRUE(std::isnan(refused.with_rad));
}

TEST(PhiError, AgainstTheTruthIsWhatPhiOffsetLacks) {
  SweepAttitude attitude = corrected_by(rad_from_deg(179.5));
  judge_by_start(rad_from_deg(-179.0), attitude);
  EXPECT_NEAR(deg_from_rad(attitude.with_rad), 1.5, 1e-9) << "a turn off makes no error";
  EXPECT_NEAR(deg_from_rad(attitude.without_rad), -179.0, 1e-9);
}

TEST(PhiError, IsNotKnownWhereThereAreNoWalls) {
  std::vector<SweepAttitude> sweeps{corrected_by(0.1), corrected_by(0.1, 1)};
  EXPECT_EQ(judge_by_walls({{}, {}}, 0.0, sweeps), Reference::kNone);
  EXPECT_TRUE(std::isnan(sweeps[0].with_rad));
}

TEST(Statistics, LeaveOutWhatIsNotKnown) {
  const AngleStatistics errors = statistics_of({kUnknownAngle, -3.0, kUnknownAngle, 1.0});
  EXPECT_EQ(errors.count, 2U);
  EXPECT_DOUBLE_EQ(errors.mean_rad, -1.0);
  EXPECT_DOUBLE_EQ(errors.rms_rad, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(errors.largest_rad(), 3.0);
  EXPECT_EQ(errors.lowest_rad, -3.0);
  EXPECT_EQ(errors.highest_rad, 1.0);
  EXPECT_EQ(statistics_of({kUnknownAngle}).count, 0U);
}

TEST(Surfaces, HaveTheSpreadOfTheirNoiseAndTheirPlaceInTheRoom) {
  const auto surfaces = find_surfaces(room(), SurfaceKind::kUpright);
  ASSERT_EQ(surfaces.size(), 4U);
  for (const Surface& surface : surfaces) {
    EXPECT_NEAR(surface.sd_m, kNoise_m, 0.0005) << surface.name;
    EXPECT_NEAR(surface.share_within, std::erf(0.040 / kNoise_m / std::sqrt(2.0)), 0.001);
    EXPECT_GT(surface.points.size(), 10'000U);
  }
  const auto any = find_surfaces(room(), SurfaceKind::kAny);
  EXPECT_TRUE(std::any_of(any.begin(), any.end(), [](const auto& s) { return s.name == "floor"; }));
}

TEST(Surfaces, ABumpTakesPointsOutOfTheBand) {
  OrganisedCloud cloud = room();
  std::size_t on_wall = 0, moved = 0;
  for (CloudPoint& point : cloud.points) {
    if (std::abs(point.x_m - 3.4F) > 0.06F || std::abs(point.y_m) > 1.8F) continue;
    ++on_wall;
    if (point.y_m < 1.0F) continue;
    point.x_m -= 0.07F;
    ++moved;
  }
  const auto surfaces = find_surfaces(cloud, SurfaceKind::kUpright);
  const auto front = std::find_if(surfaces.begin(), surfaces.end(),
                                  [](const auto& s) { return s.plane.normal.x() < -0.9; });
  ASSERT_NE(front, surfaces.end());
  EXPECT_LT(front->share_within, 0.9);
  EXPECT_GT(front->sd_m, 1.5 * kNoise_m);
  ASSERT_GT(moved, on_wall / 10);
  double left_off_m = 0.0;  // along it is to the left, off it towards the rig
  for (const SurfacePoint& point : front->points)
    if (point.along_m > 1.2 && point.along_m < 1.6) left_off_m = std::max(left_off_m, point.off_m);
  EXPECT_GT(left_off_m, 0.04);
}

TEST(SeamPlace, IsWhereTheRayMeetsTheNearestWall) {
  const auto walls = find_surfaces(room(), SurfaceKind::kUpright);
  const double azimuth_rad = rad_from_deg(100.0);
  const auto place = seam_place(walls, azimuth_rad);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->distance_m * std::sin(azimuth_rad), 2.4, 0.01);
  EXPECT_NEAR(place->along_m, -place->distance_m * std::cos(azimuth_rad), 0.01) << "to the left";
  EXPECT_FALSE(seam_place({}, azimuth_rad));
}

}  // namespace
}  // namespace swivel
