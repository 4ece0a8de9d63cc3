#include "components/common/cloud_message.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <random>

namespace swivel {
namespace {

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'789;

// Any bits at all, NaN with any payload among them.
OrganisedCloud random_cloud(std::size_t lines, std::size_t beams) {
  std::mt19937 random(5);
  OrganisedCloud cloud(lines, beams);
  for (CloudPoint& point : cloud.points) {
    for (float* value : {&point.x_m, &point.y_m, &point.z_m, &point.intensity}) {
      const auto bits =
          static_cast<std::uint32_t>(random() | (random() % 2 == 0 ? 0x7F800000U : 0U));
      std::memcpy(value, &bits, sizeof bits);
    }
  }
  return cloud;
}

PointCloud2Message message_of(const OrganisedCloud& cloud, std::int64_t stamp = kStampNs) {
  PointCloud2Message message;
  to_message(cloud, stamp, start_frame("swivel"), message);
  return message;
}

TEST(CloudMessage, ComesBackBitForBit) {
  const OrganisedCloud cloud = random_cloud(7, 13);
  OrganisedCloud back(3, 99);  // used again
  ASSERT_EQ(from_message(message_of(cloud), back), "");
  EXPECT_EQ(back.lines, 7U);
  EXPECT_EQ(back.beams, 13U);
  ASSERT_EQ(back.points.size(), cloud.points.size());
  EXPECT_EQ(std::memcmp(back.points.data(), cloud.points.data(), 7 * 13 * sizeof(CloudPoint)), 0);
}

TEST(CloudMessage, IsAPointCloud2AsRos2KnowsIt) {
  const PointCloud2Message message = message_of(random_cloud(7, 13));
  EXPECT_EQ(message.header().frame_id(), "swivel/start");
  EXPECT_EQ(message.height(), 7U);
  EXPECT_EQ(message.width(), 13U);
  EXPECT_EQ(message.point_step(), 16U);
  EXPECT_EQ(message.row_step(), 13U * 16U);
  EXPECT_EQ(message.data().size(), 7U * 13U * 16U);
  EXPECT_FALSE(message.is_bigendian());
  EXPECT_FALSE(message.is_dense());
  ASSERT_EQ(message.fields().size(), 4U);
  EXPECT_EQ(message.fields()[3].name(), "intensity");
  EXPECT_EQ(message.fields()[3].offset(), 12U);
  EXPECT_EQ(message.fields()[3].datatype(), 7);
}

TEST(CloudMessage, TheStampIsExactToTheNanosecond) {
  for (const std::int64_t stamp :
       {kStampNs, std::int64_t{0}, std::int64_t{999'999'999}, std::int64_t{1'000'000'000},
        std::int64_t{2'147'483'647'999'999'999}, std::int64_t{-1}, std::int64_t{-1'000'000'000},
        std::int64_t{-1'500'000'001}}) {
    const PointCloud2Message message = message_of(OrganisedCloud(1, 1), stamp);
    EXPECT_EQ(stamp_ns(message), stamp);
    EXPECT_LT(message.header().stamp().nanosec(), 1'000'000'000U);
  }
}

TEST(CloudMessage, EveryFaultIsRefused) {
  const std::vector<std::function<void(PointCloud2Message&)>> faults{
      [](auto& message) { message.fields().clear(); },
      [](auto& message) { message.fields().pop_back(); },
      [](auto& message) { message.fields().push_back(message.fields()[0]); },
      [](auto& message) { message.fields()[1].name("Y"); },
      [](auto& message) { message.fields()[1].offset(8); },
      [](auto& message) { message.fields()[2].datatype(8); },
      [](auto& message) { message.fields()[3].count(2); },
      [](auto& message) { std::swap(message.fields()[0], message.fields()[1]); },
      [](auto& message) { message.is_bigendian(true); },
      [](auto& message) { message.point_step(20); },
      [](auto& message) { message.point_step(0); },
      [](auto& message) { message.row_step(0); },
      [](auto& message) { message.row_step(13 * 16 + 4); },
      [](auto& message) { message.height(8); },
      [](auto& message) { message.height(0); },
      [](auto& message) { message.width(12); },
      [](auto& message) { message.width(0); },
      [](auto& message) { message.height(0xFFFFFFFFU); },
      [](auto& message) { message.width(0xFFFFFFFFU); },
      [](auto& message) { message.height(0xFFFFFFFFU), message.width(0xFFFFFFFFU); },
      [](auto& message) { message.height(20000), message.width(10000); },
      // 2^16 * 2^16 points would wrap to none.
      [](auto& message) {
        message.height(0x10000), message.width(0x10000), message.data().clear();
      },
      [](auto& message) { message.data().pop_back(); },
      [](auto& message) { message.data().push_back(0); },
      [](auto& message) { message.data().clear(); },
  };
  for (std::size_t fault = 0; fault < faults.size(); ++fault) {
    PointCloud2Message message = message_of(random_cloud(7, 13));
    faults[fault](message);
    OrganisedCloud cloud(1, 2);
    EXPECT_NE(from_message(message, cloud), "") << "fault " << fault;
    EXPECT_EQ(cloud.points.size(), 2U) << "fault " << fault;  // untouched
  }
}

TEST(CloudMessage, NoPointsAtAllIsACloudToo) {
  OrganisedCloud cloud(1, 2);
  EXPECT_EQ(from_message(message_of(OrganisedCloud()), cloud), "");
  EXPECT_TRUE(cloud.points.empty());
}

}  // namespace
}  // namespace swivel
