// LAS 1.2 read by its specification's byte offsets, apart from the code that writes it.
#include "components/swivel/recorder/timed_cloud_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace swivel {
namespace {

template <class Number>
Number at(const std::string& bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

// Two lines of three beams; the second beam of the first line is invalid.
OrganisedCloud small_cloud() {
  OrganisedCloud cloud(2, 3);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto number = static_cast<float>(i);
    cloud.points[i] = {1.25F * number, -2.5F, 0.0001F * number, 1000.0F + number};
  }
  cloud.points[1] = kMissingPoint;
  return cloud;
}

// 2024-01-01 00:00:00 UTC, which is second 1 388 102 418 of GPS.
const PointTimes kTimes{1'704'067'200'000'000'000, 25e6, 17e3};

TEST(TimedCloudFiles, LasHoldsPlaceIntensityAndTimeOfEachValidPoint) {
  const std::string las = las_bytes(small_cloud(), kTimes);
  EXPECT_EQ(las.substr(0, 4), "LASF");
  EXPECT_EQ(las.substr(24, 2), std::string("\x01\x02")) << "version";
  EXPECT_EQ(at<std::uint16_t>(las, 94), 227) << "header size";
  EXPECT_EQ(at<std::uint32_t>(las, 96), 227U) << "where the points begin";
  EXPECT_EQ(las[104], 1) << "point format";
  EXPECT_EQ(at<std::uint16_t>(las, 105), 28);
  ASSERT_EQ(at<std::uint32_t>(las, 107), 5U);
  ASSERT_EQ(las.size(), 227U + 5U * 28U);
  const double scale_m = at<double>(las, 131);
  EXPECT_DOUBLE_EQ(at<double>(las, 179), 6.25) << "largest x";
  EXPECT_DOUBLE_EQ(at<double>(las, 179 + 8), 0.0) << "smallest x";
  const std::size_t last = 227 + 4 * 28;
  EXPECT_NEAR(at<std::int32_t>(las, last) * scale_m, 6.25, 1e-9);
  EXPECT_NEAR(at<std::int32_t>(las, last + 4) * scale_m, -2.5, 1e-9);
  EXPECT_NEAR(at<std::int32_t>(las, last + 8) * scale_m, 0.0005, 1e-9);
  EXPECT_EQ(at<std::uint16_t>(las, last + 12), 1005);
  EXPECT_NEAR(at<double>(las, last + 20), 1388102418.0 - 1e9 + 0.025 + 2 * 17e-6, 1e-6);
}

TEST(TimedCloudFiles, CsvHasALineForEachValidPoint) {
  const std::string csv = csv_text(small_cloud(), kTimes);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 5);
  EXPECT_NE(csv.find("\n6.25,-2.5,0.0005,1005,1704067200025034000\n"), std::string::npos) << csv;
}

}  // namespace
}  // namespace swivel
