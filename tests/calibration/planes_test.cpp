#include "calibration/planes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/calibration/plate_case.hpp"

namespace swivel {
namespace {

// A room with the rig inside: walls at x = 3, y = 2, x = -4, y = -2.5, floor and roof, a
// cupboard whose doors stand 0.6 m before a wall, turned by yaw about Z.
class Room {
 public:
  Room(double yaw_rad, double noise_m, unsigned seed)
      : turn_(yaw_rad), random_(seed), noise_m_(0.0, noise_m) {}

  OrganisedCloud cloud(std::size_t lines, std::size_t beams) {
    OrganisedCloud cloud(lines, beams);
    for (CloudPoint& point : cloud.points) {
      const Eigen::Vector3d place = seen_along(direction());
      const Eigen::Vector2d level = turn_ * place.head<2>();
      point = {static_cast<float>(level.x()), static_cast<float>(level.y()),
               static_cast<float>(place.z()), 1.0F};
    }
    return cloud;
  }

 private:
  Eigen::Vector3d direction() {
    std::normal_distribution<double> any(0.0, 1.0);
    return Eigen::Vector3d(any(random_), any(random_), any(random_)).normalized();
  }

  // The first thing along a ray from the origin, with noise along the ray.
  Eigen::Vector3d seen_along(const Eigen::Vector3d& ray) {
    const double x_m = ray.x() > 0 ? 3.0 : -4.0;
    const double y_m = ray.y() > 0 ? 2.0 : -2.5;
    const double z_m = ray.z() > 0 ? 1.8 : -0.9;
    double range_m = std::min({x_m / ray.x(), y_m / ray.y(), z_m / ray.z()});
    const Eigen::Vector3d on_doors = ray * (2.4 / std::max(ray.x(), 1e-9));
    if (ray.x() > 0 && std::abs(on_doors.y() - 0.7) < 0.5 && on_doors.z() < 0.6) {
      range_m = std::min(range_m, 2.4 / ray.x());
    }
    return ray * (range_m + noise_m_(random_));
  }

  Eigen::Rotation2Dd turn_;
  std::mt19937 random_;
  std::normal_distribution<double> noise_m_;
};

struct KnownWall {
  double azimuth_deg;  // of the normal, towards the rig
  double distance_m;
};
const std::vector<KnownWall> kRoomWalls{{180.0, 3.0}, {-90.0, 2.0}, {0.0, 4.0}, {90.0, 2.5}};

const Plane* wall_like(const std::vector<Plane>& walls, const KnownWall& known, double yaw_rad) {
  for (const Plane& wall : walls) {
    const double off_rad =
        std::remainder(wall.azimuth_rad() - yaw_rad - rad_from_deg(known.azimuth_deg), 2 * kPi);
    if (std::abs(off_rad) < 0.05 && std::abs(wall.distance_m - known.distance_m) < 0.05) {
      return &wall;
    }
  }
  return nullptr;
}

double azimuth_error_rad(const Plane& wall, const KnownWall& known, double yaw_rad) {
  return std::remainder(wall.azimuth_rad() - yaw_rad - rad_from_deg(known.azimuth_deg), 2 * kPi);
}

TEST(Planes, FindsTheWallsOfARoomAtAnyYawAndNoise) {
  for (const double noise_m : {0.005, 0.015, 0.03}) {
    for (const double yaw_deg : {0.0, 33.0, -140.0}) {
      const double yaw_rad = rad_from_deg(yaw_deg);
      const auto walls = find_walls(Room(yaw_rad, noise_m, 3).cloud(80, 1081), 8);
      for (const KnownWall& known : kRoomWalls) {
        const Plane* const wall = wall_like(walls, known, yaw_rad);
        ASSERT_NE(wall, nullptr) << noise_m << " " << yaw_deg << " " << known.azimuth_deg;
        EXPECT_NEAR(azimuth_error_rad(*wall, known, yaw_rad), 0.0, rad_from_deg(0.1));
        EXPECT_NEAR(wall->distance_m, known.distance_m, 0.004);
        EXPECT_NEAR(wall->normal.z(), 0.0, 0.004);
        EXPECT_NEAR(wall->normal.norm(), 1.0, 1e-12);
        EXPECT_LT(wall->rms_m, 1.05 * noise_m);
        EXPECT_GT(wall->rms_m, 0.6 * noise_m);  // rays meet it aslant
        EXPECT_GT(wall->points, 1000U);
      }
    }
  }
}

TEST(Planes, WallsAreUprightAndLargestFirst) {
  const auto walls = find_walls(Room(0.3, 0.01, 5).cloud(40, 1081), 8);
  EXPECT_GE(walls.size(), 4U);
  EXPECT_LE(walls.size(), 6U);
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    EXPECT_LT(std::abs(walls[wall].normal.z()), 0.02);
    if (wall > 0) {
      EXPECT_GE(walls[wall - 1].points, walls[wall].points);
    }
  }
  EXPECT_EQ(find_walls(Room(0.3, 0.01, 5).cloud(40, 1081), 2).size(), 2U);
}

TEST(Planes, AWallReachesFurtherThanTheCupboardBeforeIt) {
  PlaneOptions options;
  options.least_share = 0.01;
  const auto walls = find_walls(Room(0.3, 0.01, 5).cloud(80, 1081), 8, options);
  const Plane* const doors = wall_like(walls, {180.0, 2.4}, 0.3);
  const Plane* const wall = wall_like(walls, kRoomWalls[0], 0.3);
  ASSERT_NE(doors, nullptr);
  ASSERT_NE(wall, nullptr);
  EXPECT_NEAR(doors->length_m, 1.0, 0.15);
  EXPECT_NEAR(doors->height_m, 1.5, 0.25);
  EXPECT_NEAR(wall->length_m, 4.5, 0.8);
  EXPECT_NEAR(wall->height_m, 2.7, 0.4);
}

// Where two walls meet at an obtuse angle, each takes points of the other.
TEST(Planes, AnObtuseCornerTurnsNeitherOfItsWalls) {
  const double other_rad = rad_from_deg(28.0);
  const Eigen::Vector2d other(std::cos(other_rad), std::sin(other_rad));
  std::mt19937 random(11);
  std::normal_distribution<double> noise_m(0.0, 0.015);
  std::uniform_real_distribution<double> azimuth_rad(-0.35, 0.75);
  std::uniform_real_distribution<double> slope(-0.4, 0.4);
  OrganisedCloud cloud(120, 1081);
  for (CloudPoint& point : cloud.points) {
    const double azimuth = azimuth_rad(random);
    const Eigen::Vector2d level(std::cos(azimuth), std::sin(azimuth));
    const double range_m = std::min(3.0 / level.x(), 3.1 / level.dot(other)) + noise_m(random);
    point = {static_cast<float>(range_m * level.x()), static_cast<float>(range_m * level.y()),
             static_cast<float>(range_m * slope(random)), 1.0F};
  }
  const auto walls = find_walls(cloud, 4);
  for (const KnownWall& known : {KnownWall{180.0, 3.0}, KnownWall{-152.0, 3.1}}) {
    const Plane* const wall = wall_like(walls, known, 0.0);
    ASSERT_NE(wall, nullptr) << known.azimuth_deg;
    EXPECT_NEAR(azimuth_error_rad(*wall, known, 0.0), 0.0, 4 * wall->azimuth_sigma_rad);
  }
}

TEST(Planes, AnyDirectionIncludesFloorAndRoofWithTheirThickness) {
  const auto planes = find_planes(Room(0.3, 0.012, 6).cloud(80, 1081), 6);
  ASSERT_GE(planes.size(), 5U);
  const auto level = [&](double height_m) {
    return std::find_if(planes.begin(), planes.end(), [&](const Plane& plane) {
      return plane.normal.z() * height_m < -0.99 * std::abs(height_m) &&
             std::abs(plane.distance_m - std::abs(height_m)) < 0.005;
    });
  };
  for (const double height_m : {1.8, -0.9}) {
    ASSERT_NE(level(height_m), planes.end()) << height_m;
    EXPECT_GT(level(height_m)->rms_m, 0.004);
    EXPECT_LT(level(height_m)->rms_m, 0.013);
  }
}

TEST(Planes, TheSigmaOfAWallsAzimuthIsHonest) {
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 25; ++seed) {
    const auto walls = find_walls(Room(0.2, 0.012, 100 + seed).cloud(10, 1081), 8);
    for (const KnownWall& known : kRoomWalls) {
      const Plane* const wall = wall_like(walls, known, 0.2);
      ASSERT_NE(wall, nullptr);
      squares += std::pow(azimuth_error_rad(*wall, known, 0.2) / wall->azimuth_sigma_rad, 2);
      ++count;
    }
  }
  EXPECT_GT(std::sqrt(squares / count), 0.7);
  EXPECT_LT(std::sqrt(squares / count), 1.5);
}

TEST(Planes, AgreeWithASimulatorsTruth) {
  const PlateCase plate_case = load_plate_case(SWIVEL_TEST_DATA "/plate_real_mode1");
  const PlateSweep& sweep = plate_case.sweeps[0];
  const auto walls = find_walls(sweep.cloud, 8);
  for (const KnownWall& known :
       {KnownWall{180.0, 3.4}, KnownWall{0.0, 2.6}, KnownWall{-90.0, 2.4}, KnownWall{90.0, 2.1}}) {
    const bool far_side = known.distance_m == 3.4;
    const KnownWall wall_known{far_side ? 180.0 : known.azimuth_deg, known.distance_m};
    const Plane* const wall = wall_like(walls, wall_known, -sweep.phi_offset_rad);
    ASSERT_NE(wall, nullptr) << known.azimuth_deg;
    EXPECT_NEAR(azimuth_error_rad(*wall, wall_known, -sweep.phi_offset_rad), 0.0,
                4 * wall->azimuth_sigma_rad);
    EXPECT_NEAR(wall->distance_m, known.distance_m, 0.002);
  }
}

TEST(Planes, TheSameCloudGivesTheSamePlanes) {
  const OrganisedCloud cloud = Room(0.3, 0.02, 8).cloud(40, 1081);
  const auto once = find_planes(cloud, 6);
  const auto again = find_planes(cloud, 6);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t plane = 0; plane < once.size(); ++plane) {
    EXPECT_EQ(once[plane].normal, again[plane].normal);
    EXPECT_EQ(once[plane].distance_m, again[plane].distance_m);
  }
}

// In a recording of a real tilting lidar the largest planes were bundles of lines, through the
// sensor. Here it looks at small round things alone, through 6 deg.
TEST(Planes, LinesNearToOneAnotherAreNone) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> range_m(0.3F, 3.0F);
  std::array<float, 100> ranges_m{};
  for (float& range : ranges_m) range = range_m(random);
  OrganisedCloud bundle(60, 500);
  for (std::size_t line = 0; line < bundle.lines; ++line) {
    const double azimuth_rad = rad_from_deg(20.0 + 0.1 * static_cast<double>(line));
    for (std::size_t beam = 0; beam < bundle.beams; ++beam) {
      const double up_rad = rad_from_deg(0.54 * static_cast<double>(beam) - 135.0);
      const auto far_m = static_cast<double>(ranges_m.at(beam / 5));
      bundle.line(line)[beam] = {
          static_cast<float>(far_m * std::cos(up_rad) * std::cos(azimuth_rad)),
          static_cast<float>(far_m * std::cos(up_rad) * std::sin(azimuth_rad)),
          static_cast<float>(far_m * std::sin(up_rad)), 0.0F};
    }
  }
  for (const Plane& plane : find_planes(bundle, 6)) {
    EXPECT_LT(plane.points, bundle.points.size() / 5) << plane.distance_m;
  }
}

TEST(Planes, WhereThereAreNoneNoneIsFound) {
  EXPECT_TRUE(find_planes(OrganisedCloud(), 6).empty());
  EXPECT_TRUE(find_planes(OrganisedCloud(40, 1081), 6).empty());
  OrganisedCloud infinite(40, 100);
  for (CloudPoint& point : infinite.points) point = {INFINITY, -INFINITY, INFINITY, 0.0F};
  EXPECT_TRUE(find_planes(infinite, 6).empty());
  OrganisedCloud one_place(40, 100);
  for (CloudPoint& point : one_place.points) point = {1.0F, 2.0F, 3.0F, 0.0F};
  EXPECT_TRUE(find_planes(one_place, 6).empty());
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place_m(-1.0F, 1.0F);
  OrganisedCloud fog(40, 500);
  for (CloudPoint& point : fog.points) {
    point = {place_m(random), place_m(random), place_m(random), 0.0F};
  }
  EXPECT_TRUE(find_planes(fog, 6).empty());
}

}  // namespace
}  // namespace swivel
