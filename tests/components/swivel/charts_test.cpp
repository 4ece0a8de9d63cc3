#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "components/swivel/pictures/attitude_charts.hpp"
#include "components/swivel/pictures/sweep_charts.hpp"
#include "scratch_folder.hpp"

namespace swivel {
namespace {

const cv::Vec3b kVermillionDot(0, 94, 213), kBlueDot(178, 114, 0), kOrangeDot(0, 159, 230);

// Below the legend.
int pixels_of(const std::string& path, const cv::Vec3b& colour) {
  const cv::Mat picture = cv::imread(path);
  int pixels = 0;
  for (int row = 110; row < picture.rows; ++row)
    for (int column = 0; column < picture.cols; ++column)
      pixels += picture.at<cv::Vec3b>(row, column) == colour ? 1 : 0;
  return pixels;
}

std::vector<SweepAttitude> sweeps(bool corrected) {
  std::vector<SweepAttitude> attitudes(3);
  for (SweepAttitude& attitude : attitudes) {
    attitude.mode = 1;
    attitude.corrected = corrected;
    attitude.phi_offset_rad = 0.05;
    judge_by_start(0.04, attitude);
  }
  return attitudes;
}

TEST(AttitudeCharts, NeverDrawASweepWithoutAttitudeAsCorrected) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("chart.png");
  for (const bool corrected : {true, false}) {
    const auto modes = by_mode(sweeps(corrected));
    const auto blue_if_corrected = [&](const Outcome& written, const char* which) {
      ASSERT_TRUE(written);
      EXPECT_GT(pixels_of(path, kVermillionDot), 50) << which;
      EXPECT_EQ(pixels_of(path, kBlueDot) > 50, corrected) << which;
    };
    blue_if_corrected(write_sweeps_chart(path, "a test", sweeps(corrected)), "sweeps");
    blue_if_corrected(write_modes_chart(path, "a test", modes), "modes");
    blue_if_corrected(write_map_error_chart(path, "a test", modes), "map error");
  }
}

TEST(PlateChart, ShowsHitsAndMissesEachInItsColour) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("plate.png");
  PlateBeam hit, miss;
  hit.x_m = miss.x_m = 0.08;
  hit.y_m = 0.02;
  miss.y_m = -0.05;
  hit.in_ring = true;
  ASSERT_TRUE(write_plate_chart(path, {hit}, {}, std::nullopt, {}));
  EXPECT_GT(pixels_of(path, kBlueDot), 0);
  EXPECT_EQ(pixels_of(path, kOrangeDot), 0);
  ASSERT_TRUE(write_plate_chart(path, {miss}, {}, PlateBeta{0.5, 0.01}, {}));
  EXPECT_EQ(pixels_of(path, kBlueDot), 0);
  EXPECT_GT(pixels_of(path, kOrangeDot), 0);
}

TEST(Charts, NothingToShowIsNoReasonToCrash) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("chart.png");
  const OrganisedCloud none, empty(3, 3);
  EXPECT_TRUE(write_sweeps_chart(path, "", {}));
  EXPECT_TRUE(write_sweeps_chart(path, "", {SweepAttitude()}));
  EXPECT_TRUE(write_modes_chart(path, "", {}));
  EXPECT_TRUE(write_map_error_chart(path, "", by_mode({SweepAttitude()})));
  EXPECT_TRUE(write_surfaces_chart(path, {}, {}));
  EXPECT_TRUE(write_surfaces_chart(path, {Surface()}, {}));
  for (const OrganisedCloud* cloud : {&none, &empty})
    EXPECT_TRUE(write_seam_chart(path, *cloud, {}, {kUnknownAngle, kUnknownAngle}, {}));
  EXPECT_TRUE(write_plate_chart(path, {}, {}, std::nullopt, {}));
  EXPECT_FALSE(write_modes_chart(scratch.file("none/chart.png"), "", {}));
}

}  // namespace
}  // namespace swivel
