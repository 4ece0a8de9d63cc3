#include "components/swivel/pictures/map_frame.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swivel {
namespace {

// A room of 6 m x 4 m from floor to ceiling: walls, and far denser floor and ceiling.
OrganisedCloud room(float floor_m, float ceiling_m) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(0.0F, 1.0F);
  OrganisedCloud cloud(4, 20000);
  for (std::size_t point = 0; point < 20000; ++point) {
    const float x_m = 6.0F * part(random) - 2.0F, y_m = 4.0F * part(random) - 1.0F;
    const float z_m = floor_m + (ceiling_m - floor_m) * part(random);
    cloud.line(0)[point] = {x_m, y_m, floor_m, 0.0F};
    cloud.line(1)[point] = {x_m, y_m, ceiling_m, 0.0F};
    cloud.line(2)[point] = {4.0F, y_m, z_m, 0.0F};
    cloud.line(3)[point] = {x_m, -1.0F, z_m, 0.0F};
  }
  return cloud;
}

TEST(HeightBand, LeavesOutFloorAndCeilingAndKeepsTheWalls) {
  const OrganisedCloud cloud = room(-0.7F, 1.9F);
  const HeightBand band = band_between_floor_and_ceiling(cloud);
  EXPECT_GT(band.lowest_m, -0.7F);
  EXPECT_LT(band.lowest_m, -0.4F);
  EXPECT_LT(band.highest_m, 1.9F);
  EXPECT_GT(band.highest_m, 1.6F);
  EXPECT_FALSE(band.holds(cloud.line(0)[5]));
  EXPECT_FALSE(band.holds(cloud.line(1)[5]));
}

TEST(HeightBand, WithoutFloorOrCeilingAllIsShown) {
  OrganisedCloud cloud = room(-0.7F, 1.9F);
  for (const std::size_t line : {0U, 1U})
    for (std::size_t beam = 0; beam < cloud.beams; ++beam) cloud.line(line)[beam] = kMissingPoint;
  const HeightBand band = band_between_floor_and_ceiling(cloud);
  for (const std::size_t line : {2U, 3U})
    for (std::size_t beam = 0; beam < cloud.beams; ++beam)
      ASSERT_TRUE(band.holds(cloud.line(line)[beam]));
}

TEST(MapFrame, XIsRightYIsUpAxesAreEqualAndAllIsInside) {
  const OrganisedCloud cloud = room(-0.7F, 1.9F);
  const MapFrame frame({&cloud}, band_between_floor_and_ceiling(cloud), 300, 200);
  EXPECT_NEAR(frame.column_of(1.0) - frame.column_of(0.0), frame.pixels_per_m(), 1e-9);
  EXPECT_NEAR(frame.row_of(0.0) - frame.row_of(1.0), frame.pixels_per_m(), 1e-9);
  EXPECT_GT(frame.pixels_per_m(), 35.0);
  for (const CloudPoint& corner :
       {CloudPoint{4.0F, -1.0F, 0.0F, 0.0F}, CloudPoint{-2.0F, 3.0F, 0.0F, 0.0F},
        CloudPoint{0.0F, 0.0F, 0.0F, 0.0F}})
    EXPECT_TRUE(frame.pixel_of(corner));
  EXPECT_FALSE(frame.pixel_of({40.0F, 0.0F, 0.0F, 0.0F}));
}

TEST(MapFrame, AFewStrayPointsDoNotShrinkTheMap) {
  OrganisedCloud cloud = room(-0.7F, 1.9F);
  const HeightBand band = band_between_floor_and_ceiling(cloud);
  const double before = MapFrame({&cloud}, band, 300, 300).pixels_per_m();
  cloud.line(2)[7] = {500.0F, -300.0F, 0.5F, 0.0F};
  EXPECT_NEAR(MapFrame({&cloud}, band, 300, 300).pixels_per_m(), before, 0.5);
}

TEST(MapFrame, AnEmptyCloudHasAMapToo) {
  const OrganisedCloud cloud(3, 3);
  const MapFrame frame({&cloud}, band_between_floor_and_ceiling(cloud), 100, 100);
  EXPECT_GT(frame.pixels_per_m(), 0.0);
  EXPECT_TRUE(frame.pixel_of({0.0F, 0.0F, 0.0F, 0.0F}));
}

}  // namespace
}  // namespace swivel
