#include "calibration/plate_learning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/plate_outline.hpp"
#include "tests/calibration/plate_case.hpp"
#include "tests/calibration/yuans_rig.hpp"

namespace swivel {
namespace {

PlateFit a_fit() {
  const PlateCase plate_case = load_plate_case(std::string(SWIVEL_TEST_DATA) + "/plate_real_mode1");
  return *estimate_by_plate_outline(plate_case.sweeps[0].cloud, PlateGeometry(), yuans_rig()).fit;
}

// Of one fit nothing can be learned that it does not say already.
TEST(PlateLearning, OneFitStaysWhatItIs) {
  const PlateFit fit = a_fit();
  const LearnedPlate learned = learn_plate({fit}, PlateShape());
  EXPECT_NEAR(learned.betas_rad[0].value, fit.beta_rad, 1e-9);
  EXPECT_NEAR(learned.betas_rad[0].sigma, fit.beta_sigma_rad, 1e-9);
  EXPECT_NEAR(learned.shape.roll_rad.value, fit.shape.roll_rad.value, 1e-9);
  EXPECT_NEAR(learned.shape.height_m.value, fit.shape.height_m.value, 1e-9);
  EXPECT_NEAR(learned.residual_m, fit.residual_m, 1e-12);
}

// What was known before counts once: M equal fits are M times the sweep's own information.
TEST(PlateLearning, ManyFitsSharpenTheShapeAndTheKnownBeforeCountsOnce) {
  const PlateFit fit = a_fit();
  PlateShape drawn;
  const double own = 1.0 / std::pow(fit.shape.roll_rad.sigma, 2);
  double last_sigma_rad = fit.shape.roll_rad.sigma;
  for (const std::size_t count : {2U, 3U}) {
    const LearnedPlate learned = learn_plate(std::vector<PlateFit>(count, fit), drawn);
    const double sigma_rad = learned.shape.roll_rad.sigma;
    EXPECT_LT(sigma_rad, last_sigma_rad);
    EXPECT_GT(sigma_rad, 0.99 / std::sqrt(static_cast<double>(count) * own) * 0.9);
    EXPECT_LT(learned.betas_rad[0].sigma, fit.beta_sigma_rad);
    last_sigma_rad = sigma_rad;
  }
}

// A rig whose edges are sharper than drawn is known for it, but for none sharper than beams can
// tell.
TEST(PlateLearning, TheSoftnessIsLearnedDownToWhatBeamsCanTell) {
  PlateFit fit = a_fit();
  const PlateShape drawn;
  for (const double softness_m : {0.0005, 0.00002}) {
    fit.shape.log_softness.value = std::log(softness_m);
    const LearnedPlate learned = learn_plate({fit}, drawn);
    EXPECT_NEAR(std::exp(learned.shape.log_softness.value), std::max(softness_m, 0.0002), 1e-9);
    EXPECT_LT(learned.shape.log_softness.sigma, drawn.log_softness.sigma);
    EXPECT_GE(learned.shape.log_softness.sigma, 0.5);
  }
}

// A fit whose roll was off by chance: told the roll of all, its azimuth goes along with it.
TEST(PlateLearning, AFitIsPulledToTheShapeOfAll) {
  const PlateFit fit = a_fit();
  PlateFit off = fit;
  const ShapeVector shift = (ShapeVector() << 0.0, rad_from_deg(0.2), 0.0, 0.0, 0.0).finished();
  off.shape.roll_rad.value += shift[1];
  off.beta_rad += fit.beta_by_shape.dot(shift);
  std::vector<PlateFit> fits(20, fit);
  fits.push_back(off);
  const LearnedPlate learned = learn_plate(fits, PlateShape());
  EXPECT_NEAR(learned.betas_rad.back().value, learned.betas_rad.front().value, 1e-9);
  EXPECT_GT(std::abs(off.beta_rad - fit.beta_rad), rad_from_deg(0.01));
}

}  // namespace
}  // namespace swivel
