#include "calibration/plate_learning.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace swivel {
namespace {

// No plate is known better than this, however many sweeps say so: none is quite flat, and the look
// of its edges changes with what stands behind.
constexpr double kLeastHeightSigma_m = 0.0001;
constexpr double kLeastTiltSigma_rad = rad_from_deg(0.05);
constexpr double kLeastGrowthSigma_m = 0.0001;
constexpr double kLeastLogSoftnessSigma = 0.5;

// No edge is taken for sharper: beams lie further apart, and what is told by none of them makes the
// next fit restless.
constexpr double kSharpestEdge_m = 0.0002;

ShapeVector values_of(const PlateShape& shape) {
  ShapeVector values;
  values << shape.height_m.value, shape.roll_rad.value, shape.pitch_rad.value, shape.growth_m.value,
      shape.log_softness.value;
  return values;
}

ShapeMatrix information_of(const PlateShape& shape) {
  ShapeVector sigmas;
  sigmas << shape.height_m.sigma, shape.roll_rad.sigma, shape.pitch_rad.sigma, shape.growth_m.sigma,
      shape.log_softness.sigma;
  return sigmas.array().square().inverse().matrix().asDiagonal();
}

// Eq. (18): every fit holds what was known before; all together hold it once.
struct Combined {
  ShapeVector values;
  ShapeMatrix covariance;
};

Combined combine(const std::vector<PlateFit>& fits, const PlateShape& drawn) {
  const ShapeMatrix before = information_of(drawn);
  ShapeMatrix information = before;
  ShapeVector weighted = before * values_of(drawn);
  for (const PlateFit& fit : fits) {
    information += fit.shape_information - before;
    weighted += fit.shape_information * values_of(fit.shape) - before * values_of(drawn);
  }
  const ShapeMatrix covariance = information.inverse();
  return {covariance * weighted, covariance};
}

PlateShape shape_of(const Combined& all, const PlateShape& drawn) {
  const auto known = [&](Eigen::Index index, double least_sigma) {
    return Known{all.values[index], std::max(std::sqrt(all.covariance(index, index)), least_sigma)};
  };
  PlateShape shape = drawn;
  shape.height_m = known(0, kLeastHeightSigma_m);
  shape.roll_rad = known(1, kLeastTiltSigma_rad);
  shape.pitch_rad = known(2, kLeastTiltSigma_rad);
  shape.growth_m = known(3, kLeastGrowthSigma_m);
  shape.log_softness = known(4, kLeastLogSoftnessSigma);
  shape.log_softness.value = std::max(shape.log_softness.value, std::log(kSharpestEdge_m));
  return shape;
}

// What is left of a fit's azimuth, and of its doubt, once the shape is known from elsewhere.
Known beta_with(const Combined& all, const PlateFit& fit) {
  const ShapeVector off = all.values - values_of(fit.shape);
  const ShapeMatrix gained = fit.shape_information.inverse() - all.covariance;
  const double variance =
      fit.beta_sigma_rad * fit.beta_sigma_rad - fit.beta_by_shape.dot(gained * fit.beta_by_shape);
  const double least = 0.01 * fit.beta_sigma_rad * fit.beta_sigma_rad;
  return {fit.beta_rad + fit.beta_by_shape.dot(off), std::sqrt(std::max(variance, least))};
}

}  // namespace

LearnedPlate learn_plate(const std::vector<PlateFit>& fits, const PlateShape& drawn) {
  assert(!fits.empty());
  const Combined all = combine(fits, drawn);
  LearnedPlate learned;
  learned.shape = shape_of(all, drawn);
  Known offset_m;
  double variance = 0.0;
  const auto count = static_cast<double>(fits.size());
  for (const PlateFit& fit : fits) {
    learned.betas_rad.push_back(beta_with(all, fit));
    learned.residual_m += fit.residual_m / count;
    offset_m.value += fit.shape.range_offset_m.value / count;
    variance += fit.shape.range_offset_m.sigma * fit.shape.range_offset_m.sigma;
  }
  offset_m.sigma = std::sqrt(variance) / count;
  learned.shape.range_offset_m = offset_m;
  return learned;
}

}  // namespace swivel
