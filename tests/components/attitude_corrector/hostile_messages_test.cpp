// Clouds, sweeps and calibrations that no participant of ours would send. What matters is that the
// corrector comes back, and calls nothing good; the sanitizers look on.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "components/attitude_corrector/corrector.hpp"
#include "components/attitude_corrector/sweep_and_cloud.hpp"
#include "components/common/calibration_file.hpp"
#include "components/common/cloud_message.hpp"
#include "tests/calibration/plate_case.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr float kInfinity_m = std::numeric_limits<float>::infinity();
constexpr float kNone_m = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 9> kExtremes_m{kNone_m, kInfinity_m, -kInfinity_m, 3e38F, -3e38F,
                                           1e-40F,  0.0F,        0.08F,        -0.06F};

RigFile rig_with(const std::string& estimator) {
  RigFile rig;
  rig.path = "yuan.yaml";
  rig.geometry = yuans_rig();
  rig.plate = PlateGeometry();
  rig.estimator = estimator;
  return rig;
}

OrganisedCloud cloud_of_the_plate() {
  return load_plate_case(std::string(SWIVEL_TEST_DATA) + "/plate_clean_mode1").sweeps[0].cloud;
}

class HostileClouds : public testing::TestWithParam<const char*> {};

TEST_P(HostileClouds, OfAnyShapeAndOfNoNumbersAreNotGood) {
  Corrector corrector(rig_with(GetParam()));
  for (const std::size_t lines : {0, 1, 2, 40}) {
    for (const std::size_t beams : {0, 1, 3, 1081}) {
      for (const float value_m : kExtremes_m) {
        OrganisedCloud cloud(lines, beams);
        std::fill(cloud.points.begin(), cloud.points.end(),
                  CloudPoint{value_m, value_m, value_m, value_m});
        const msg::Attitude attitude = corrector.correct(msg::Sweep(), cloud);
        EXPECT_NE(attitude.verdict(), msg::VERDICT_GOOD)
            << lines << " x " << beams << " of " << value_m;
      }
    }
  }
}

// The plate is there, and so is anything else.
TEST_P(HostileClouds, OfAPlateAmidGarbageDoNoHarm) {
  Corrector corrector(rig_with(GetParam()));
  const OrganisedCloud plate = cloud_of_the_plate();
  std::mt19937 random(6);
  for (int round = 0; round < 6; ++round) {
    OrganisedCloud cloud = plate;
    for (CloudPoint& point : cloud.points) {
      if (random() % 8 > static_cast<unsigned>(round)) continue;
      point.x_m = kExtremes_m[random() % kExtremes_m.size()];
      point.y_m = kExtremes_m[random() % kExtremes_m.size()];
      point.z_m = kExtremes_m[random() % kExtremes_m.size()];
    }
    const msg::Attitude attitude = corrector.correct(msg::Sweep(), cloud);
    if (attitude.verdict() != msg::VERDICT_GOOD) continue;
    EXPECT_TRUE(std::isfinite(attitude.phi_offset_deg()));
    EXPECT_GT(attitude.phi_offset_sigma_deg(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, HostileClouds, testing::Values("plate_outline", "ring_mean"));

TEST(HostileCalibrations, WithValuesBeyondAllSenseDoNoHarm) {
  for (const double value : {1e308, -1e308, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    Corrector corrector(rig_with("plate_outline"));
    msg::Calibration calibration;
    calibration.alpha_deg(value);
    calibration.bias_deg(value);
    calibration.mounting_xyz_mm({value, value, value});
    calibration.mounting_rpy_deg({value, value, value});
    calibration.covariance().fill(std::abs(value));
    calibration.plate_shape().fill(value);
    calibration.plate_shape_sigma().fill(std::abs(value));
    calibration.plate_residual_mm(value);
    const bool refused = !corrector.set_calibration(calibration).empty();
    OrganisedCloud cloud = cloud_of_the_plate();
    const msg::Attitude attitude = corrector.correct(msg::Sweep(), cloud);
    if (refused) continue;
    EXPECT_NE(attitude.verdict(), msg::VERDICT_GOOD) << value;
  }
}

// However many sweeps are told of, and however large their clouds claim to be.
TEST(HostileMessages, AreRefusedAndCountedInBoundedMemory) {
  SweepAndCloud pair;
  msg::Sweep sweep;
  sweep.phase(msg::PHASE_ASSEMBLED);
  sweep.lines_used(1);
  for (int number = 1; number <= 1000; ++number) {
    sweep.sweep_id(static_cast<std::uint64_t>(number));
    sweep.first_beam_time_ns(number);
    pair.add(sweep);
  }
  EXPECT_EQ(pair.sweeps_without_cloud(), 1000U - 16U);
  PointCloud2Message message;
  to_message(OrganisedCloud(2, 3), 1000, "swivel/start", message);
  const std::vector<std::function<void(PointCloud2Message&)>> lies{
      [](auto& lie) { lie.height(0xFFFFFFFF); },
      [](auto& lie) { lie.width(0xFFFFFFFF); },
      [](auto& lie) { lie.height(0x10000), lie.width(0x10000); },
      [](auto& lie) { lie.data().resize(5); },
      [](auto& lie) { lie.point_step(0); },
      [](auto& lie) { lie.row_step(1); },
      [](auto& lie) { lie.is_bigendian(true); },
      [](auto& lie) { lie.fields().clear(); },
      [](auto& lie) { lie.fields()[2].offset(0xFFFFFFFF); },
      [](auto& lie) { lie.fields()[0].count(7); }};
  for (const auto& tell : lies) {
    PointCloud2Message lie = message;
    tell(lie);
    EXPECT_FALSE(pair.add(lie).empty());
    EXPECT_FALSE(pair.complete());
  }
  EXPECT_EQ(pair.clouds_refused(), lies.size());
  EXPECT_TRUE(pair.add(message).empty());
  EXPECT_TRUE(pair.complete());
}

}  // namespace
}  // namespace swivel
