#include "components/swivel/offline/cloud_files.hpp"

#include <gmock/gmock.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cstring>
#include <random>

#include "scratch_folder.hpp"

namespace swivel {
namespace {

// Every bit of a float may be in it; each 7th point is invalid but has an intensity.
OrganisedCloud random_cloud(std::size_t lines, std::size_t beams) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place_m(-10.0F, 10.0F), intensity(0.0F, 4000.0F);
  OrganisedCloud cloud(lines, beams);
  for (std::size_t place = 0; place < cloud.points.size(); ++place) {
    CloudPoint& point = cloud.points[place];
    point = kMissingPoint;
    point.intensity = intensity(random);
    if (place % 7 == 3) continue;
    point = {place_m(random), place_m(random), place_m(random), point.intensity};
  }
  return cloud;
}

TEST(Pcd, ReadsBackBitForBitInItsOrder) {
  const ScratchFolder scratch;
  const OrganisedCloud cloud = random_cloud(13, 29);
  ASSERT_TRUE(write_pcd(scratch.file("cloud.pcd"), cloud));
  pcl::PCLPointCloud2 read;
  ASSERT_EQ(pcl::io::loadPCDFile(scratch.file("cloud.pcd"), read), 0);
  EXPECT_EQ(read.width, 29U);
  EXPECT_EQ(read.height, 13U);
  ASSERT_EQ(read.data.size(), cloud.points.size() * sizeof(CloudPoint));
  EXPECT_EQ(std::memcmp(read.data.data(), cloud.points.data(), read.data.size()), 0);
}

TEST(Pcd, PointsOfPclSeeTheSameFields) {
  const ScratchFolder scratch;
  const OrganisedCloud cloud = random_cloud(3, 5);
  ASSERT_TRUE(write_pcd(scratch.file("cloud.pcd"), cloud));
  pcl::PointCloud<pcl::PointXYZI> read;
  ASSERT_EQ(pcl::io::loadPCDFile(scratch.file("cloud.pcd"), read), 0);
  EXPECT_FALSE(read.is_dense);
  for (std::size_t place = 0; place < read.size(); ++place) {
    EXPECT_EQ(read[place].intensity, cloud.points[place].intensity);
    EXPECT_EQ(std::isnan(read[place].x), place % 7 == 3);
    if (place % 7 == 3) continue;
    EXPECT_EQ(read[place].y, cloud.points[place].y_m);
  }
}

TEST(Ply, HoldsTheValidPointsBitForBitAndSaysHowManyItLeftOut) {
  const ScratchFolder scratch;
  const OrganisedCloud cloud = random_cloud(10, 14);
  const auto left_out = write_ply(scratch.file("cloud.ply"), cloud);
  ASSERT_TRUE(left_out);
  EXPECT_EQ(*left_out, 20U);
  pcl::PCLPointCloud2 read;
  ASSERT_EQ(pcl::io::loadPLYFile(scratch.file("cloud.ply"), read), 0);
  EXPECT_EQ(read.height, 1U);
  ASSERT_EQ(read.width, 120U);
  ASSERT_EQ(read.point_step, sizeof(CloudPoint));
  std::size_t place = 0;
  for (const CloudPoint& point : cloud.points) {
    if (!point.valid()) continue;
    EXPECT_EQ(std::memcmp(&read.data[sizeof(CloudPoint) * place++], &point, sizeof point), 0);
  }
}

TEST(Ply, HasNoCameraAndNoFaces) {
  const ScratchFolder scratch;
  ASSERT_TRUE(write_ply(scratch.file("cloud.ply"), random_cloud(4, 4)));
  const std::string content = content_of(scratch.file("cloud.ply"));
  const std::string header = content.substr(0, content.find("end_header"));
  EXPECT_THAT(header, testing::HasSubstr("binary_little_endian"));
  EXPECT_THAT(header, testing::HasSubstr("element vertex 14"));
  EXPECT_THAT(header, testing::HasSubstr("2 invalid points"));
  for (const char* element : {"camera", "face", "range_grid"})
    EXPECT_THAT(header, testing::Not(testing::HasSubstr(element)));
}

TEST(CloudFiles, WhatCannotBeWrittenIsSaidAndLeavesNothing) {
  const ScratchFolder scratch;
  const OrganisedCloud cloud = random_cloud(2, 2);
  const Outcome pcd = write_pcd(scratch.file("none/cloud.pcd"), cloud);
  ASSERT_FALSE(pcd);
  EXPECT_THAT(pcd.reason(), testing::HasSubstr("none/cloud.pcd"));
  EXPECT_FALSE(write_ply(scratch.file("none/cloud.ply"), cloud));
  std::filesystem::create_directory(scratch.file("taken.pcd"));
  EXPECT_FALSE(write_pcd(scratch.file("taken.pcd"), cloud));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("taken.pcd.part")));
}

TEST(CloudFiles, ACloudWithoutAValidPointIsWrittenToo) {
  const ScratchFolder scratch;
  EXPECT_TRUE(write_pcd(scratch.file("cloud.pcd"), OrganisedCloud(2, 3)));
  const auto left_out = write_ply(scratch.file("cloud.ply"), OrganisedCloud(2, 3));
  ASSERT_TRUE(left_out) << left_out.reason();
  EXPECT_EQ(*left_out, 6U);
}

}  // namespace
}  // namespace swivel
