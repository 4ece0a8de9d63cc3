#include "components/gateway/packed_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace swivel {
namespace {

TEST(PackedPoints, AreWithinHalfAMillimetre) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-32.76F, 32.76F);
  for (int round = 0; round < 20000; ++round) {
    const CloudPoint point{place(random), place(random), place(random), 900.0F};
    const PackedPoint small = packed(point);
    ASSERT_EQ(small.flag, PointFlag::kPoint);
    ASSERT_NEAR(small.x_mm, 1000.0 * static_cast<double>(point.x_m), 0.5021);
    ASSERT_NEAR(small.y_mm, 1000.0 * static_cast<double>(point.y_m), 0.5021);
    ASSERT_NEAR(small.z_mm, 1000.0 * static_cast<double>(point.z_m), 0.5021);
    ASSERT_EQ(small.root_intensity, 30);
  }
}

TEST(PackedPoints, TellFarFromNone) {
  EXPECT_EQ(packed(kMissingPoint).flag, PointFlag::kNone);
  EXPECT_EQ(packed({0.0F, 40.0F, 0.0F, 1.0F}).flag, PointFlag::kFar);
  EXPECT_EQ(packed({0.0F, 32.0F, -32.0F, 1.0F}).flag, PointFlag::kPoint);
}

// The sanitizers watch.
TEST(PackedPoints, TakeAnyBits) {
  std::mt19937 random(2);
  for (int round = 0; round < 20000; ++round) {
    std::uint32_t bits[4];
    for (auto& word : bits) word = random() | (random() % 2 == 0 ? 0x7F800000U : 0U);
    CloudPoint point;
    std::memcpy(&point, bits, sizeof point);
    const PackedPoint small = packed(point);
    const bool inside =
        std::abs(point.x_m) < 32.0F && std::abs(point.y_m) < 32.0F && std::abs(point.z_m) < 32.0F;
    ASSERT_TRUE(!inside || small.flag == PointFlag::kPoint);
    ASSERT_TRUE(small.flag == PointFlag::kPoint || small.x_mm == 0);
  }
}

TEST(PackedPoints, AFrameIsItsHeadAndItsPointsFromAnyAddress) {
  const std::vector<CloudPoint> cloud{{1.0F, 2.0F, 3.0F, 100.0F}, {-4.0F, 5.0F, -6.0F, 0.0F}};
  std::string shifted(1, 'x');
  shifted.append(reinterpret_cast<const char*>(cloud.data()), cloud.size() * sizeof(CloudPoint));
  const std::string frame = packed_frame({FrameKind::kCloud, 9, 1, 2, 0, 1}, shifted.data() + 1);
  ASSERT_EQ(frame.size(), 24U + 2U * 8U);
  std::uint32_t head[6];
  std::memcpy(head, frame.data(), sizeof head);
  EXPECT_EQ(head[0], 2U);
  EXPECT_EQ(head[1], 9U);
  EXPECT_EQ(head[3], 2U);
  const std::string second("\x60\xf0\x88\x13\x90\xe8\x00\x01", 8);  // -4000, 5000, -6000
  EXPECT_EQ(frame.substr(32), second);
}

}  // namespace
}  // namespace swivel
