#include "calibration/line_assembly.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/calibration/unlike_rig.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

constexpr std::size_t kBeams = 1081;
const std::vector<std::uint16_t> kNoIntensities;

ForwardModel model_of(const RigGeometry& rig) {
  return {rig, rad_from_deg(-135.0), rad_from_deg(0.25), kBeams};
}

std::vector<std::uint16_t> random_line(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> range_mm(60, 10000);
  std::vector<std::uint16_t> line(kBeams);
  for (std::uint16_t& value : line) value = static_cast<std::uint16_t>(range_mm(random));
  return line;
}

void expect_is_forward_model(const ForwardModel& model, const std::vector<std::uint16_t>& ranges_mm,
                             double axis_angle_rad, double angle_per_beam_rad,
                             const std::vector<CloudPoint>& row) {
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double angle_rad = axis_angle_rad + static_cast<double>(beam) * angle_per_beam_rad;
    const Eigen::Vector3d expected = model.point(beam, ranges_mm[beam] * 1e-3, angle_rad);
    const Eigen::Vector3f point(row[beam].x_m, row[beam].y_m, row[beam].z_m);
    ASSERT_LT((point.cast<double>() - expected).norm(), 3e-7 * ranges_mm[beam] * 1e-3 + 1e-8)
        << "beam " << beam;
  }
}

TEST(LineAssembly, EveryBeamIsTheForwardModelAtItsOwnAngle) {
  for (const RigGeometry& rig : {yuans_rig(), unlike_rig()}) {
    const ForwardModel model = model_of(rig);
    LineAssembler assembler(model);
    std::vector<CloudPoint> row(kBeams);
    unsigned seed = 0;
    for (const double angle_per_beam_rad : {0.0, 5.45e-5, 3.4e-6, -2.7e-5}) {
      for (const double axis_angle_rad : {-0.4, 0.0, 1.9, 3.2}) {
        const auto ranges_mm = random_line(++seed);
        assembler.assemble({ranges_mm, kNoIntensities, 60, 10000}, axis_angle_rad,
                           angle_per_beam_rad, row.data());
        expect_is_forward_model(model, ranges_mm, axis_angle_rad, angle_per_beam_rad, row);
      }
    }
  }
}

// Estimates of the period creep from line to line; what is kept of the line before must not.
TEST(LineAssembly, AnAnglePerBeamThatCreepsStaysExact) {
  const ForwardModel model = model_of(unlike_rig());
  LineAssembler assembler(model);
  std::vector<CloudPoint> row(kBeams);
  const std::vector<std::uint16_t> ranges_mm(kBeams, 10000);
  double angle_per_beam_rad = 5.45e-5;
  for (int line = 0; line < 40; ++line) {
    assembler.assemble({ranges_mm, kNoIntensities, 60, 10000}, 0.5, angle_per_beam_rad, row.data());
    expect_is_forward_model(model, ranges_mm, 0.5, angle_per_beam_rad, row);
    angle_per_beam_rad += 9e-10 / 40 * line;
  }
}

TEST(LineAssembly, AnglesBeamByBeamGiveTheSameRow) {
  const ForwardModel model = model_of(unlike_rig());
  LineAssembler assembler(model);
  const auto ranges_mm = random_line(77);
  std::vector<double> angles_rad(kBeams);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    angles_rad[beam] = 0.7 + 5e-5 * static_cast<double>(beam);
  }
  std::vector<CloudPoint> row(kBeams);
  assembler.assemble({ranges_mm, kNoIntensities, 60, 10000}, angles_rad, row.data());
  expect_is_forward_model(model, ranges_mm, 0.7, 5e-5, row);
}

TEST(LineAssembly, CodesAndRangesOutOfLimitsAreNoPointsButKeepTheirIntensity) {
  const ForwardModel model = model_of(yuans_rig());
  LineAssembler assembler(model);
  auto ranges_mm = random_line(5);
  std::vector<std::uint16_t> intensities(kBeams);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    intensities[beam] = static_cast<std::uint16_t>(60 * beam);
  }
  const std::vector<std::uint16_t> bad_mm{0, 4, 59, 10001, 65533, 65535};
  for (std::size_t beam = 0; beam < bad_mm.size(); ++beam) ranges_mm[100 * beam] = bad_mm[beam];
  ranges_mm[1079] = 60;
  ranges_mm[1080] = 10000;
  std::vector<CloudPoint> row(kBeams);
  assembler.assemble({ranges_mm, intensities, 60, 10000}, 0.3, 1e-5, row.data());
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const bool bad = beam % 100 == 0 && beam / 100 < bad_mm.size();
    EXPECT_EQ(row[beam].valid(), !bad) << beam;
    EXPECT_EQ(std::isnan(row[beam].y_m), bad);
    EXPECT_EQ(std::isnan(row[beam].z_m), bad);
    EXPECT_EQ(row[beam].intensity, static_cast<float>(intensities[beam]));
  }
}

TEST(LineAssembly, WithoutIntensitiesTheyAreZeroAlsoAfterALineThatHadSome) {
  LineAssembler assembler(model_of(yuans_rig()));
  const auto ranges_mm = random_line(6);
  const std::vector<std::uint16_t> intensities(kBeams, 9);
  std::vector<CloudPoint> row(kBeams);
  assembler.assemble({ranges_mm, intensities, 60, 10000}, 0.3, 1e-5, row.data());
  assembler.assemble({ranges_mm, kNoIntensities, 60, 10000}, 0.3, 1e-5, row.data());
  for (const CloudPoint& point : row) EXPECT_EQ(point.intensity, 0.0F);
}

}  // namespace
}  // namespace swivel
