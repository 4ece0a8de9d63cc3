// What every estimator of the attitude must do, and how well each does it.
#include "calibration/attitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "calibration/forward_model.hpp"
#include "tests/calibration/plate_case.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

const PlateGeometry kPlate;

AttitudeEstimate estimate_by(const std::string& name, const OrganisedCloud& cloud) {
  return (*attitude_estimator(name, yuans_rig()))(cloud, kPlate);
}

struct Recorded {
  OrganisedCloud cloud;
  double beta_rad = 0.0;  // truth
};

Recorded recorded(const std::string& name) {
  PlateCase plate_case = load_plate_case(std::string(SWIVEL_TEST_DATA) + "/" + name);
  return {plate_case.sweeps[0].cloud, plate_case.alpha_rad - plate_case.sweeps[0].phi_offset_rad};
}

class Estimator : public testing::TestWithParam<const char*> {
 protected:
  static AttitudeEstimate estimate(const OrganisedCloud& cloud) {
    return estimate_by(GetParam(), cloud);
  }

  static void expect_refused(const OrganisedCloud& cloud, AttitudeVerdict verdict) {
    const AttitudeEstimate result = estimate(cloud);
    EXPECT_EQ(result.verdict, verdict) << result.reason;
    EXPECT_TRUE(std::isnan(result.beta_rad));
    EXPECT_FALSE(result.reason.empty());
  }
};

INSTANTIATE_TEST_SUITE_P(Each, Estimator, testing::Values("ring_mean", "plate_outline"),
                         [](const auto& name) { return std::string(name.param); });

// Where beam `beam` of line `line` meets the plate's plane: straight from the forward model, by
// the recordings' mode 1.
Eigen::Vector3d at_plate(std::size_t line, std::size_t beam) {
  static const ForwardModel model(yuans_rig(), rad_from_deg(-135.0), rad_from_deg(0.25), 1081);
  const double down = -std::cos(model.beam_angle_rad(beam));
  const double turns = static_cast<double>(line) + static_cast<double>(beam) / 1440.0;
  return model.point(beam, down > 0.1 ? kPlate.depth_m / down : 100.0, turns * rad_from_deg(4.5));
}

// Does to every point that the beams aimed at some part of the plate's plane measured.
void change(OrganisedCloud& cloud, const std::function<bool(double, double)>& part_deg_m,
            const std::function<void(CloudPoint&, const Eigen::Vector3d&)>& what) {
  for (std::size_t line = 0; line < cloud.lines; ++line) {
    for (std::size_t beam = 0; beam < 200; ++beam) {
      const Eigen::Vector3d met = at_plate(line, beam);
      const double azimuth_deg = deg_from_rad(std::atan2(met.y(), met.x()));
      if (part_deg_m(azimuth_deg, met.head<2>().norm())) what(cloud.line(line)[beam], met);
    }
  }
}

void to_the_plane(CloudPoint& point, const Eigen::Vector3d& met) {
  point.x_m = static_cast<float>(met.x());
  point.y_m = static_cast<float>(met.y());
  point.z_m = static_cast<float>(met.z());
}

void far_away(CloudPoint& point, const Eigen::Vector3d& met) {
  to_the_plane(point, 20.0 * met);
}

void close_by(CloudPoint& point, const Eigen::Vector3d& met) {
  to_the_plane(point, 0.5 * met);
}

TEST(RingMean, FindsThePlateOfSimulatedSweepsWithinThePapersAccuracy) {
  for (const std::string name : {"plate_clean_mode1", "plate_real_mode1"}) {
    const Recorded sweep = recorded(name);
    const AttitudeEstimate result = estimate_by("ring_mean", sweep.cloud);
    ASSERT_EQ(result.verdict, AttitudeVerdict::kGood) << name << ": " << result.reason;
    const double error_rad = result.beta_rad - sweep.beta_rad;
    EXPECT_LT(std::abs(error_rad), rad_from_deg(1.9)) << name;
    EXPECT_LT(std::abs(error_rad), 4 * result.beta_sigma_rad) << name;
    EXPECT_LT(result.beta_sigma_rad, rad_from_deg(1.0));
    EXPECT_GT(result.points_used, 300U);
    EXPECT_GT(result.edges_used, 30U);
    EXPECT_GT(result.residual_m, 0.003);
    EXPECT_LT(result.residual_m, 0.010);
  }
}

// 20 mm of noise, a deck 40 mm below, the plate tilted: a constant of 1.2 deg comes on top.
TEST(RingMean, HoldsOnARoughRig) {
  const Recorded sweep = recorded("plate_rough_mode1");
  const AttitudeEstimate result = estimate_by("ring_mean", sweep.cloud);
  ASSERT_EQ(result.verdict, AttitudeVerdict::kGood) << result.reason;
  EXPECT_LT(std::abs(result.beta_rad - sweep.beta_rad), rad_from_deg(1.9 + 1.2));
}

// The rough one: a deck close behind the plate, which is tilted by 1.5 deg.
TEST(PlateOutline, FindsThePlateTenTimesBetter) {
  for (const std::string name : {"plate_clean_mode1", "plate_real_mode1", "plate_rough_mode1"}) {
    const Recorded sweep = recorded(name);
    const AttitudeEstimate result = estimate_by("plate_outline", sweep.cloud);
    ASSERT_EQ(result.verdict, AttitudeVerdict::kGood) << name << ": " << result.reason;
    EXPECT_LT(std::abs(result.beta_rad - sweep.beta_rad), 2.5 * result.beta_sigma_rad) << name;
    EXPECT_LT(result.beta_sigma_rad, rad_from_deg(name == "plate_rough_mode1" ? 0.5 : 0.15));
    EXPECT_GT(result.points_used, 300U);
    EXPECT_GT(result.edges_used, 100U);
  }
}

TEST_P(Estimator, TurningTheCloudTurnsBetaByAsMuch) {
  const Recorded sweep = recorded("plate_real_mode1");
  const double beta_rad = estimate(sweep.cloud).beta_rad;
  for (const double turn_deg : {-20.0, -7.0, 3.0, 10.0}) {
    const Eigen::Rotation2Dd turn(rad_from_deg(turn_deg));
    OrganisedCloud turned = sweep.cloud;
    for (CloudPoint& point : turned.points) {
      const Eigen::Vector2d place = turn * Eigen::Vector2d(point.x_m, point.y_m);
      point.x_m = static_cast<float>(place.x());
      point.y_m = static_cast<float>(place.y());
    }
    const AttitudeEstimate result = estimate(turned);
    ASSERT_EQ(result.verdict, AttitudeVerdict::kGood) << turn_deg << ": " << result.reason;
    EXPECT_NEAR(result.beta_rad - beta_rad, rad_from_deg(turn_deg), 1e-5);
  }
}

TEST_P(Estimator, NoPlateIsSaidSoWithAndWithoutADeckBelow) {
  for (const std::string name : {"plate_clean_mode1", "plate_real_mode1", "plate_rough_mode1"}) {
    Recorded sweep = recorded(name);
    const auto near_plate = [&](double azimuth_deg, double) {
      return std::abs(azimuth_deg - deg_from_rad(sweep.beta_rad)) < 70.0;
    };
    change(sweep.cloud, near_plate, far_away);
    expect_refused(sweep.cloud, AttitudeVerdict::kNoPlate);
  }
}

TEST_P(Estimator, ACableAnywhereInTheRingIsSeen) {
  for (const double from_deg : {-80.0, -60.0, -45.0, 76.0}) {
    Recorded sweep = recorded("plate_real_mode1");
    const auto cable = [&](double azimuth_deg, double radius_m) {
      return azimuth_deg > from_deg && azimuth_deg < from_deg + 11.0 && radius_m > 0.07 &&
             radius_m < 0.09;
    };
    change(sweep.cloud, cable, to_the_plane);
    expect_refused(sweep.cloud, AttitudeVerdict::kForeignObject);
  }
}

TEST_P(Estimator, ACableThatOverlapsASideOfThePlateIsSeen) {
  for (const double side : {-1.0, 1.0}) {
    Recorded sweep = recorded("plate_clean_mode1");
    const auto cable = [&](double azimuth_deg, double radius_m) {
      const double from_middle_deg = side * (azimuth_deg - deg_from_rad(sweep.beta_rad));
      return from_middle_deg > 25.0 && from_middle_deg < 50.0 && radius_m > 0.08 &&
             radius_m < 0.105;
    };
    change(sweep.cloud, cable, to_the_plane);
    expect_refused(sweep.cloud, AttitudeVerdict::kForeignObject);
  }
}

TEST_P(Estimator, AHiddenPartOfThePlateIsSeen) {
  for (const auto& hide : {far_away, close_by}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double from_deg : {0.0, 15.0}) {
        Recorded sweep = recorded("plate_clean_mode1");
        const auto hidden = [&](double azimuth_deg, double) {
          return side * (azimuth_deg - deg_from_rad(sweep.beta_rad)) > from_deg;
        };
        change(sweep.cloud, hidden, hide);
        expect_refused(sweep.cloud, AttitudeVerdict::kForeignObject);
      }
    }
  }
}

std::size_t line_at_plate(const Recorded& sweep) {
  for (std::size_t line = 0; line < sweep.cloud.lines; ++line) {
    const Eigen::Vector3d met = at_plate(line, 30);
    if (std::atan2(met.y(), met.x()) > sweep.beta_rad) return line;
  }
  return 0;
}

TEST_P(Estimator, LinesMissingOnThePlateAreSeenWhereverTheyAre) {
  for (const std::size_t shift : {0U, 4U, 8U, 12U, 16U}) {
    Recorded sweep = recorded("plate_real_mode1");
    const std::size_t middle = line_at_plate(sweep) + shift - 8;
    for (std::size_t line = middle - 1; line <= middle + 1; ++line) {
      std::fill_n(sweep.cloud.line(line), sweep.cloud.beams, kMissingPoint);
    }
    expect_refused(sweep.cloud, AttitudeVerdict::kLinesMissing);
  }
}

TEST_P(Estimator, ALineThatSawNothingOnThePlateCountsAsMissing) {
  Recorded sweep = recorded("plate_clean_mode1");
  const std::size_t line = line_at_plate(sweep);
  for (std::size_t beam = 0; beam < 200; ++beam) {
    sweep.cloud.line(line)[beam] = {NAN, NAN, NAN, 0.0F};
  }
  expect_refused(sweep.cloud, AttitudeVerdict::kLinesMissing);
}

TEST_P(Estimator, LinesMissingElsewhereDoNotMatter) {
  Recorded sweep = recorded("plate_clean_mode1");
  const double beta_rad = estimate(sweep.cloud).beta_rad;
  for (const std::size_t line : {1U, 2U, 38U}) {
    std::fill_n(sweep.cloud.line(line), sweep.cloud.beams, kMissingPoint);
  }
  EXPECT_NEAR(estimate(sweep.cloud).beta_rad, beta_rad,
              1e-4);  // what ranges say is learned from all
}

TEST_P(Estimator, ASweepThatEndsOnThePlateIsRefused) {
  Recorded sweep = recorded("plate_clean_mode1");
  OrganisedCloud half(line_at_plate(sweep) + 4, sweep.cloud.beams);
  std::copy_n(sweep.cloud.points.begin(), half.points.size(), half.points.begin());
  expect_refused(half, AttitudeVerdict::kLinesMissing);
}

TEST_P(Estimator, NoiseAloneIsNeverGood) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place_m(-0.2F, 0.2F);
    OrganisedCloud cloud(40, 1081);
    for (CloudPoint& point : cloud.points) {
      point = {place_m(random), place_m(random), place_m(random), 0.0F};
    }
    EXPECT_NE(estimate(cloud).verdict, AttitudeVerdict::kGood);
  }
}

TEST_P(Estimator, DegenerateCloudsAreRefusedWithoutACrash) {
  expect_refused(OrganisedCloud(), AttitudeVerdict::kNoPlate);
  expect_refused(OrganisedCloud(40, 0), AttitudeVerdict::kNoPlate);
  expect_refused(OrganisedCloud(40, 1081), AttitudeVerdict::kNoPlate);
  OrganisedCloud infinite(40, 100);
  for (CloudPoint& point : infinite.points) point = {INFINITY, -INFINITY, -INFINITY, 0.0F};
  expect_refused(infinite, AttitudeVerdict::kNoPlate);
  OrganisedCloud one_place(40, 100);
  for (CloudPoint& point : one_place.points) point = {0.08F, 0.0F, -0.0609F, 0.0F};
  EXPECT_NE(estimate(one_place).verdict, AttitudeVerdict::kGood);
}

// A plate of known azimuth under beams with range noise, from the forward model.
OrganisedCloud synthetic_sweep(std::size_t lines, double beta_rad, double phase, unsigned seed) {
  constexpr std::size_t kLowBeams = 125;  // down to where they pass over the ring
  const ForwardModel model(yuans_rig(), rad_from_deg(-135.0), rad_from_deg(0.25), kLowBeams);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_m(0.0, 0.013);
  OrganisedCloud cloud(lines, kLowBeams);
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::size_t beam = 0; beam < kLowBeams; ++beam) {
      const double turns = static_cast<double>(line) + static_cast<double>(beam) / 1440.0 + phase;
      const double angle_rad = turns * kPi / static_cast<double>(lines);
      const double range_m = kPlate.depth_m / -std::cos(model.beam_angle_rad(beam));
      const Eigen::Vector3d met = model.point(beam, range_m, angle_rad);
      const double u = std::cos(beta_rad) * met.x() + std::sin(beta_rad) * met.y() - 0.05475;
      const double v = std::abs(std::cos(beta_rad) * met.y() - std::sin(beta_rad) * met.x());
      const bool on_plate = u > 0.0 && u + v < 0.056;
      to_the_plane(cloud.line(line)[beam],
                   model.point(beam, (on_plate ? range_m : 3.0) + noise_m(random), angle_rad));
      cloud.line(line)[beam].intensity = 0.0F;
    }
  }
  return cloud;
}

double rms_of_errors_in_sigmas(const std::string& name, std::size_t lines, int runs) {
  std::mt19937 random(static_cast<unsigned>(lines));
  std::uniform_real_distribution<double> beta_deg(20.0, 40.0);
  std::uniform_real_distribution<double> phase(0.0, 1.0);
  double squares = 0.0;
  for (int run = 0; run < runs; ++run) {
    const double beta_rad = rad_from_deg(beta_deg(random));
    const AttitudeEstimate result =
        estimate_by(name, synthetic_sweep(lines, beta_rad, phase(random), 1000U + run));
    EXPECT_EQ(result.verdict, AttitudeVerdict::kGood) << result.reason;
    squares += std::pow((result.beta_rad - beta_rad) / result.beta_sigma_rad, 2);
  }
  return std::sqrt(squares / runs);
}

TEST(RingMean, SigmaIsHonest) {
  for (const std::size_t lines : {40U, 160U}) {
    const double errors_in_sigmas = rms_of_errors_in_sigmas("ring_mean", lines, 100);
    EXPECT_GT(errors_in_sigmas, 0.75) << lines;
    EXPECT_LT(errors_in_sigmas, 1.35) << lines;
  }
}

TEST(AttitudeEstimators, AreFoundByName) {
  EXPECT_TRUE(attitude_estimator("ring_mean", yuans_rig()));
  EXPECT_TRUE(attitude_estimator("plate_outline", yuans_rig()));
  EXPECT_FALSE(attitude_estimator("ring_meen", yuans_rig()));
}

TEST(AttitudeEstimators, PhiOffsetIsAlphaLessBeta) {
  EXPECT_DOUBLE_EQ(phi_offset_rad(0.5, 0.2), 0.3);
}

}  // namespace
}  // namespace swivel
