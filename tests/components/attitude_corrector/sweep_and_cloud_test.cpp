#include "components/attitude_corrector/sweep_and_cloud.hpp"

#include <gtest/gtest.h>

#include "components/common/cloud_message.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kStampNs = 1'700'000'000'000'000'001;

msg::Sweep sweep(std::int64_t number) {
  msg::Sweep sweep;
  sweep.sweep_id(static_cast<std::uint64_t>(number));
  sweep.phase(msg::PHASE_ASSEMBLED);
  sweep.first_beam_time_ns(kStampNs + number);
  sweep.lines_used(2);
  sweep.lines_expected(2);
  sweep.complete(true);
  return sweep;
}

PointCloud2Message cloud(std::int64_t number) {
  OrganisedCloud points(2, 3);
  points.points[0].x_m = static_cast<float>(number);
  PointCloud2Message message;
  to_message(points, kStampNs + number, "swivel/start", message);
  return message;
}

void expect_pair(SweepAndCloud& pair, std::int64_t number) {
  ASSERT_TRUE(pair.complete());
  EXPECT_EQ(pair.sweep().sweep_id(), static_cast<std::uint64_t>(number));
  EXPECT_EQ(pair.cloud().points.at(0).x_m, static_cast<float>(number));
  pair.clear();
  EXPECT_FALSE(pair.complete());
}

TEST(SweepAndCloud, MeetInEitherOrder) {
  SweepAndCloud pair;
  EXPECT_FALSE(pair.add(sweep(1)));
  EXPECT_EQ(pair.add(cloud(1)), "");
  expect_pair(pair, 1);
  EXPECT_EQ(pair.add(cloud(2)), "");
  EXPECT_FALSE(pair.complete());
  EXPECT_TRUE(pair.add(sweep(2)));
  expect_pair(pair, 2);
  EXPECT_EQ(pair.clouds_refused() + pair.sweeps_without_cloud(), 0U);
}

TEST(SweepAndCloud, OneNanosecondApartIsNotTheSame) {
  SweepAndCloud pair;
  EXPECT_FALSE(pair.add(sweep(1)));
  EXPECT_EQ(pair.add(cloud(2)), "");
  EXPECT_FALSE(pair.complete());
}

TEST(SweepAndCloud, CountsSweepsWhoseCloudNeverCame) {
  SweepAndCloud pair;
  for (int number = 1; number <= 3; ++number) EXPECT_FALSE(pair.add(sweep(number)));
  EXPECT_EQ(pair.add(cloud(3)), "");
  expect_pair(pair, 3);
  EXPECT_EQ(pair.sweeps_without_cloud(), 2U);
}

TEST(SweepAndCloud, CountsCloudsWhoseSweepNeverCame) {
  SweepAndCloud pair;
  EXPECT_EQ(pair.add(cloud(1)), "");
  EXPECT_EQ(pair.add(cloud(2)), "");
  EXPECT_TRUE(pair.add(sweep(2)));
  expect_pair(pair, 2);
  EXPECT_EQ(pair.clouds_refused(), 1U);
}

TEST(SweepAndCloud, ARefusedCloudMeetsNoSweep) {
  PointCloud2Message broken = cloud(1);
  broken.data().resize(7);
  SweepAndCloud pair;
  EXPECT_FALSE(pair.add(sweep(1)));
  EXPECT_NE(pair.add(broken), "");
  EXPECT_FALSE(pair.complete());
  EXPECT_EQ(pair.clouds_refused(), 1U);
  EXPECT_EQ(pair.add(cloud(1)), "");
  expect_pair(pair, 1);
}

TEST(SweepAndCloud, ASweepTakenBackBeforeItsCloudCameMeetsNone) {
  msg::Sweep taken_back = sweep(1);
  taken_back.complete(false);
  taken_back.lines_used(0);
  SweepAndCloud pair;
  EXPECT_FALSE(pair.add(sweep(1)));
  EXPECT_FALSE(pair.add(taken_back));
  EXPECT_EQ(pair.add(cloud(1)), "");
  EXPECT_FALSE(pair.complete());
  EXPECT_EQ(pair.sweeps_without_cloud(), 1U);
}

TEST(SweepAndCloud, HoldsABoundedNumberOfSweeps) {
  SweepAndCloud pair;
  for (int number = 1; number <= 1000; ++number) EXPECT_FALSE(pair.add(sweep(number)));
  EXPECT_EQ(pair.sweeps_without_cloud(), 1000U - 16U);
  EXPECT_EQ(pair.add(cloud(984)), "");
  EXPECT_FALSE(pair.complete());
  EXPECT_EQ(pair.add(cloud(985)), "");
  expect_pair(pair, 985);
}

}  // namespace
}  // namespace swivel
