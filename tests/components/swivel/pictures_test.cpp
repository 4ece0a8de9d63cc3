#include "components/swivel/pictures/pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "scratch_folder.hpp"

namespace swivel {
namespace {

// A square of 4 m about the origin, turned, with a mark in its corner at (+, +).
OrganisedCloud square(float angle_rad) {
  OrganisedCloud cloud(5, 2000);
  for (std::size_t point = 0; point < 2000; ++point) {
    const float along_m = static_cast<float>(point) * 0.002F - 2.0F;
    const float z_m = static_cast<float>(point % 40) * 0.05F - 1.0F;
    const float xs_m[] = {along_m, along_m, 2.0F, -2.0F, 1.5F + 0.1F * along_m};
    const float ys_m[] = {2.0F, -2.0F, along_m, along_m, 1.5F};
    for (std::size_t line = 0; line < 5; ++line) {
      const float c = std::cos(angle_rad), s = std::sin(angle_rad);
      cloud.line(line)[point] = {c * xs_m[line] - s * ys_m[line], s * xs_m[line] + c * ys_m[line],
                                 z_m, 1.0F};
    }
  }
  return cloud;
}

const cv::Vec3b kVermillion(0, 94, 213), kBlue(178, 114, 0), kOrange(0, 159, 230);

int count(const cv::Mat& picture, const cv::Vec3b& colour) {
  int pixels = 0;
  for (int row = 80; row < 1160; ++row)
    for (int column = 80; column < 1160; ++column)
      pixels += picture.at<cv::Vec3b>(row, column) == colour ? 1 : 0;
  return pixels;
}

// Mean place of a colour inside of a part of the map, in parts of the map: X right, Y up.
bool holds(const cv::Mat& picture, const cv::Vec3b& colour, cv::Rect2d part) {
  for (double y = part.y; y < part.y + part.height; y += 0.0005)
    for (double x = part.x; x < part.x + part.width; x += 0.0005)
      if (picture.at<cv::Vec3b>(80 + static_cast<int>(1079 * (1.0 - y)),
                                80 + static_cast<int>(1079 * x)) == colour)
        return true;
  return false;
}

PictureCaption caption(std::optional<double> phi_offset_rad) {
  return {"a test", "O", 3, 4, "good", phi_offset_rad};
}

TEST(TopView, IsAPngOfItsSizeWithTheCloudWhereItIs) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("view.png");
  ASSERT_TRUE(write_top_view(path, nullptr, square(0.0F), caption(std::nullopt)));
  EXPECT_EQ(content_of(path).substr(0, 4), "\x89PNG");
  const cv::Mat picture = cv::imread(path);
  ASSERT_EQ(picture.cols, kPictureWidth_pixels);
  ASSERT_EQ(picture.rows, kPictureHeight_pixels);
  // The map's margin is 6 %: a metre is 0.22 of it. The mark is at (1.5, 1.5), and nowhere else.
  const double right = 0.5 + 1.5 * 0.22, left = 0.5 - 1.5 * 0.22;
  EXPECT_TRUE(holds(picture, kBlue, {right - 0.02, right - 0.02, 0.04, 0.04}));
  EXPECT_FALSE(holds(picture, kBlue, {left - 0.02, right - 0.02, 0.04, 0.04}));
  EXPECT_FALSE(holds(picture, kBlue, {right - 0.02, left - 0.02, 0.04, 0.04}));
  EXPECT_EQ(count(picture, kVermillion), 0);
  EXPECT_EQ(count(picture, kOrange), 0);
}

TEST(TopView, ShowsBeforeAfterAndTheSeamOnItsOwnSide) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("view.png");
  const OrganisedCloud before = square(-0.1F);
  ASSERT_TRUE(write_top_view(path, &before, square(0.0F), caption(0.1)));
  const cv::Mat picture = cv::imread(path);
  EXPECT_GT(count(picture, kVermillion), 3000);
  EXPECT_GT(count(picture, kBlue), 3000);
  EXPECT_GT(count(picture, kOrange), 2000);
  // Counter-clockwise: the seam's upper end leans to the left, its lower end to the right.
  EXPECT_TRUE(holds(picture, kOrange, {0.40, 0.9, 0.1, 0.01}));
  EXPECT_FALSE(holds(picture, kOrange, {0.50, 0.9, 0.1, 0.01}));
  EXPECT_TRUE(holds(picture, kOrange, {0.50, 0.1, 0.1, 0.01}));
}

TEST(TopView, DrawsACloudWithoutAttitudeNeverAsCorrected) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("view.png");
  PictureCaption refused = caption(std::nullopt);
  refused.uncorrected = true;
  ASSERT_TRUE(write_top_view(path, nullptr, square(0.0F), refused));
  const cv::Mat picture = cv::imread(path);
  EXPECT_GT(count(picture, kVermillion), 3000);
  EXPECT_EQ(count(picture, kBlue), 0);
}

TEST(DensityView, IsBrightWhereThePointsAre) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("density.png");
  ASSERT_TRUE(write_density_view(path, square(0.0F), caption(0.1)));
  const cv::Mat picture = cv::imread(path);
  ASSERT_EQ(picture.cols, kPictureWidth_pixels);
  const auto brightness = [&](double x, double y) {
    const cv::Vec3b colour = picture.at<cv::Vec3b>(80 + static_cast<int>(1079 * (1.0 - y)),
                                                   80 + static_cast<int>(1079 * x));
    return int{colour[1]} + int{colour[2]};
  };
  const double right = 0.5 + 1.5 * 0.22;
  EXPECT_GT(brightness(right, right), brightness(0.3, 0.3) + 100);
}

TEST(Pictures, AnEmptyCloudIsNoReasonToCrash) {
  const ScratchFolder scratch;
  const OrganisedCloud empty(3, 3), none;
  for (const OrganisedCloud* cloud : {&empty, &none}) {
    EXPECT_TRUE(write_top_view(scratch.file("a.png"), cloud, *cloud, caption(0.0)));
    EXPECT_TRUE(write_density_view(scratch.file("b.png"), *cloud, caption(0.0)));
  }
}

TEST(Pictures, WhatCannotBeWrittenIsSaid) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("none/view.png");
  const Outcome written = write_density_view(path, square(0.0F), caption(0.0));
  ASSERT_FALSE(written);
  EXPECT_NE(written.reason().find(path), std::string::npos);
}

}  // namespace
}  // namespace swivel
