#include "components/common/plate_shape_message.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/units.hpp"

namespace swivel {
namespace {

TEST(PlateShapeMessage, GoesThereAndBackInTheUnitsOfTheWire) {
  LearnedPlate plate;
  plate.shape.height_m = {0.0002, 0.0001};
  plate.shape.roll_rad = {rad_from_deg(1.5), rad_from_deg(0.05)};
  plate.shape.log_softness = {std::log(0.0008), 0.5};
  plate.residual_m = 0.013;
  msg::Calibration calibration;
  EXPECT_FALSE(plate_shape_of(calibration)) << "one that did not look at the plate";

  to_message(plate, calibration);
  EXPECT_NEAR(calibration.plate_shape()[0], 0.2, 1e-12);
  EXPECT_NEAR(calibration.plate_shape()[1], 1.5, 1e-12);
  EXPECT_NEAR(calibration.plate_shape()[4], 0.8, 1e-12);
  EXPECT_NEAR(calibration.plate_shape_sigma()[4], 0.4, 1e-12);
  EXPECT_NEAR(calibration.plate_residual_mm(), 13.0, 1e-12);

  const auto shape = plate_shape_of(calibration);
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->height_m.value, 0.0002, 1e-15);
  EXPECT_NEAR(shape->roll_rad.value, rad_from_deg(1.5), 1e-15);
  EXPECT_NEAR(shape->pitch_rad.sigma, plate.shape.pitch_rad.sigma, 1e-15);
  EXPECT_NEAR(shape->log_softness.value, std::log(0.0008), 1e-12);
  EXPECT_NEAR(shape->log_softness.sigma, 0.5, 1e-12);
}

TEST(PlateShapeMessage, WhatIsNoShapeIsNotTaken) {
  msg::Calibration calibration;
  to_message(LearnedPlate(), calibration);
  calibration.plate_shape()[4] = -1.0;  // a softness below zero
  EXPECT_FALSE(plate_shape_of(calibration));
  to_message(LearnedPlate(), calibration);
  calibration.plate_shape_sigma()[2] = std::nan("");
  EXPECT_FALSE(plate_shape_of(calibration));
}

}  // namespace
}  // namespace swivel
