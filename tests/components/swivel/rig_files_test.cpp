// The rig files of the recorded rigs, against the formulas and truths that come with them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "calibration/forward_model.hpp"
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/rig_file.hpp"
#include "components/recording/recording.hpp"

namespace swivel {
namespace {

RigFile rig_file(const std::string& name) {
  return load_rig_file(std::string(SWIVEL_CONFIG) + "/rigs/" + name + ".yaml");
}

Eigen::Vector3d point(const RigGeometry& geometry, double angle_rad, double beam_rad,
                      double range_m) {
  return ForwardModel(geometry, beam_rad, 0.01, 2).point(0, range_m, angle_rad);
}

// The driver's own formula: at tilt t the sensor stands at (R sin t, 0, R cos t), R = 0.08 m, and
// is turned by t about Y; a beam leaves a level sensor along (cos theta, sin theta, 0).
TEST(TiltingRig, MapsABeamAsItsDriverSays) {
  const RigFile rig = rig_file("tilting");
  for (const double tilt : {0.0, 0.31, 0.97}) {
    for (const double theta : {-1.7, 0.2, 1.1}) {
      const double range_m = 1.3 + tilt;
      const double along = range_m * std::cos(theta);
      const Eigen::Vector3d expected(0.08 * std::sin(tilt) + along * std::cos(tilt),
                                     range_m * std::sin(theta),
                                     0.08 * std::cos(tilt) - along * std::sin(tilt));
      EXPECT_LT((point(rig.geometry, tilt, theta, range_m) - expected).norm(), 1e-12);
    }
  }
  EXPECT_TRUE(rig.axis_measured);
  EXPECT_FALSE(rig.plate);
}

// Zeng 2018, section 2: x = r sin theta cos phi, y = r sin theta sin phi, z = r cos theta, phi
// being the azimuth of the scan plane; here it is that of its normal, a quarter turn behind.
TEST(ZengRig, MapsABeamAsThePaperSays) {
  const RigFile rig = rig_file("zeng");
  for (const double phi : {0.0, 0.4, 2.9}) {
    for (const double theta : {-2.0, 0.3, 1.2}) {
      const Eigen::Vector3d expected(std::sin(theta) * std::cos(phi),
                                     std::sin(theta) * std::sin(phi), std::cos(theta));
      EXPECT_LT((point(rig.geometry, phi - kPi / 2, theta, 2.5) - 2.5 * expected).norm(), 1e-12);
    }
  }
  EXPECT_TRUE(rig.axis_measured);
  EXPECT_FALSE(rig.plate);
}

OrganisedCloud pan_cloud(double bias_rad) {
  auto recording = Recording::open(std::string(SWIVEL_TEST_DATA) + "/recordings/pan_sparse");
  AssemblyOptions options;
  options.geometry = rig_file("zeng").geometry;
  options.geometry.bias_rad = bias_rad;
  options.axis_measured = true;
  OrganisedCloud cloud;
  Assembler assembler(options, [&](AssembledSweep&& assembled) {
    EXPECT_TRUE(assembled.sweep.complete());
    cloud = std::move(assembled.cloud);
  });
  while (true) {
    auto event = recording->next();
    if (!event || !event->has_value()) break;
    std::visit(
        [&](const auto& message) {
          if constexpr (!std::is_same_v<decltype(message), const msg::Calibration&>)
            assembler.add(message);
        },
        (*event)->message);
  }
  assembler.finish();
  return cloud;
}

// truth.csv of the case.
constexpr double kTrueBias_rad = rad_from_deg(3.983231417750294);
constexpr double kRoof_m = 2.0;

// Mean distance from the roof of the points about the zenith.
double roof_deviation_m(double bias_rad) {
  double deviation_m = 0.0;
  int points = 0;
  for (const CloudPoint& p : pan_cloud(bias_rad).points) {
    if (!p.valid() || std::hypot(p.x_m, p.y_m) > 1.2F || p.z_m < 1.0F) continue;
    deviation_m += std::abs(static_cast<double>(p.z_m) - kRoof_m);
    ++points;
  }
  EXPECT_GT(points, 3000);
  return deviation_m / points;
}

TEST(ZengRig, TheRoofIsFlatWithTheTrueBiasAndWithNoOther) {
  EXPECT_LT(roof_deviation_m(kTrueBias_rad), 0.012);  // range noise of 10 mm
  EXPECT_GT(roof_deviation_m(0.0), 0.03);
  EXPECT_GT(roof_deviation_m(-kTrueBias_rad), 0.06);
}

TEST(ZengRig, TheWallsStandWhereTheyAre) {
  int near = 0, points = 0;
  for (const CloudPoint& p : pan_cloud(kTrueBias_rad).points) {
    if (!p.valid() || p.z_m < -0.5F || p.z_m > 1.5F) continue;
    const float distances_m[] = {p.x_m - 3.4F, p.x_m + 2.6F, p.y_m - 2.4F, p.y_m + 2.1F};
    ++points;
    for (const float distance_m : distances_m) near += std::abs(distance_m) < 0.04F ? 1 : 0;
  }
  EXPECT_GT(points, 5000);
  EXPECT_GT(near, 0.95 * points);
}

}  // namespace
}  // namespace swivel
