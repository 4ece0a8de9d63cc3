#include "calibration/plate_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/plate_evidence.hpp"

namespace swivel {
namespace {

using Information = Eigen::Matrix<double, kPlateParameters, kPlateParameters>;
using KnownBefore = std::array<Known, kPlateParameters>;

constexpr double kFlip = 0.01;             // of beams that say the wrong thing, whatever they saw
constexpr double kFar = 5.0;               // softnesses from the edge
constexpr double kLargestTurn_rad = 0.02;  // in one step
constexpr double kLargestSoftening = 1.0;  // likewise, of the logarithm
constexpr double kSharpest_m = 0.00003;    // softness: finer than the beams lie
constexpr double kSoftStart_m = 0.002;     // so that a first azimuth beside the edge finds it

// An edge before something close behind looks otherwise: it has a growth of its own, and little
// to say.
constexpr double kNearTrust = 0.1;
constexpr Known kNearGrowth_m{0.0, 0.002};

// First coarsely, from an azimuth that is a degree off, on some of the beams; then with all.
struct Round {
  std::size_t most_beams;
  double least_zone_m;  // beams further from the outline know nothing of it
  double converged;     // square of a step, in sigmas
};
constexpr std::array<Round, 2> kRounds{Round{4000, 0.014, 0.3}, Round{100'000, 0.0025, 0.01}};
constexpr int kMostIterations = 20;

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x * std::sqrt(0.5));
}

double normal_density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * kPi);
}

struct Normal {
  Information information = Information::Zero();
  PlateParameters gradient = PlateParameters::Zero();
  double misfit = 0.0;  // sum of squared residuals, by their variance
  double beams = 0.0;   // trusted ones
};

// Eqs. (15) and (16): the gradient of the log-likelihood of one beam, and Fisher's information.
void add_beam(const EdgeBeam& edge, const PlateTriangle& triangle, const PlateFrame& frame,
              const PlateParameters& parameters, Normal& normal) {
  const PlateMeeting at = frame.meeting(edge.beam);
  const double trust = edge.near ? kNearTrust : 1.0;
  normal.beams += trust;
  const PlateParameter growth = edge.near ? kGrowthNear : kGrowth;
  const auto [inside_m, by_height, slant] = depth_of(edge, at, triangle, parameters);
  const double softness_m = frame.softness_m() * slant;
  const double x = inside_m / softness_m;
  if (std::abs(x) > kFar) {  // sure of its side: it moves nothing, but may be wrong
    const double wrong = (x > 0.0 ? 1.0 : edge.odds) / (1.0 + edge.odds);
    normal.misfit += trust * wrong * wrong / (kFlip * (1.0 - kFlip));
    return;
  }
  const double chance = kFlip + (1.0 - 2.0 * kFlip) * normal_cdf(x);
  const double steepness = (1.0 - 2.0 * kFlip) * normal_density(x);
  const double variance = chance * (1.0 - chance);
  const double hit = chance * edge.odds / (chance * edge.odds + 1.0 - chance);

  PlateParameters by = PlateParameters::Zero();
  by[kBeta] = PlateTriangle::into(edge.edge, at.v, -at.u);
  by[kHeight] = by_height;
  by[kRoll] = by_height * at.v;
  by[kPitch] = by_height * (at.u - triangle.middle_m());
  by[growth] = slant;
  by[kLogSoftness] = -x * softness_m;
  by *= steepness / softness_m;
  const double known = edge.sureness * edge.sureness;
  normal.information.noalias() += (trust * known / variance * by) * by.transpose();
  normal.gradient += (trust * (hit - chance) / variance) * by;
  normal.misfit += trust * (hit - chance) * (hit - chance) / variance;
}

KnownBefore known_before(const PlateShape& shape, double beta_rad) {
  KnownBefore known;
  known[kBeta] = {beta_rad, 2 * kPi};
  known[kHeight] = shape.height_m;
  known[kRoll] = shape.roll_rad;
  known[kPitch] = shape.pitch_rad;
  known[kGrowth] = shape.growth_m;
  known[kLogSoftness] = shape.log_softness;
  known[kGrowthNear] = kNearGrowth_m;
  return known;
}

Normal normal_equations(const std::vector<EdgeBeam>& beams, const PlateTriangle& triangle,
                        const KnownBefore& before, const PlateParameters& parameters) {
  const PlateFrame frame(parameters, triangle.middle_m());
  Normal normal;
  for (const EdgeBeam& beam : beams) add_beam(beam, triangle, frame, parameters, normal);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double precision = 1.0 / (before[i].sigma * before[i].sigma);
    normal.information(row, row) += precision;
    normal.gradient[row] += precision * (before[i].value - parameters[row]);
  }
  return normal;
}

// Fisher scoring; shorter steps where it goes to and fro. Returns the covariance; none if it does
// not come to rest.
std::optional<Information> climb(const std::vector<EdgeBeam>& beams, const PlateTriangle& triangle,
                                 const KnownBefore& before, double converged,
                                 PlateParameters& parameters, double& misfit) {
  double last = std::numeric_limits<double>::infinity();
  double part = 1.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Normal normal = normal_equations(beams, triangle, before, parameters);
    const Information covariance = normal.information.inverse();
    PlateParameters step = covariance * normal.gradient;
    misfit = normal.misfit / std::max(normal.beams, 1.0);
    const double square = step.dot(normal.gradient);
    if (!std::isfinite(square)) return std::nullopt;
    if (square > last) part *= 0.5;
    last = square;
    step[kBeta] = std::clamp(step[kBeta], -kLargestTurn_rad, kLargestTurn_rad);
    step[kLogSoftness] = std::clamp(step[kLogSoftness], -kLargestSoftening, kLargestSoftening);
    step[kLogSoftness] =
        std::max(step[kLogSoftness], std::log(kSharpest_m) - parameters[kLogSoftness]);
    parameters += part * step;
    if (step.dot(normal.information * step) < converged) return covariance;
  }
  return std::nullopt;
}

PlateShape shape_of(const PlateParameters& parameters, const Information& covariance,
                    const PlateRanges& ranges) {
  const auto told = [&](PlateParameter index) {
    return Known{parameters[index], std::sqrt(covariance(index, index))};
  };
  const double mean_sigma_m =
      1.25 * ranges.rms_m / std::sqrt(static_cast<double>(std::max<std::size_t>(ranges.hits, 1)));
  return {told(kHeight), told(kRoll),        told(kPitch),
          told(kGrowth), told(kLogSoftness), {ranges.offset_m, mean_sigma_m}};
}

}  // namespace

std::optional<PlateFit> fit_plate(const std::vector<PlateBeam>& beams, const PlateGeometry& plate,
                                  double beta_rad) {
  const PlateTriangle triangle(plate);
  const KnownBefore before = known_before(plate.shape, beta_rad);
  PlateParameters parameters;
  for (std::size_t i = 0; i < before.size(); ++i)
    parameters[static_cast<Eigen::Index>(i)] = before[i].value;
  parameters[kLogSoftness] = std::max(parameters[kLogSoftness], std::log(kSoftStart_m));

  PlateFit fit;
  PlateRanges ranges;
  std::optional<Information> covariance;
  for (const Round& round : kRounds) {
    const std::size_t stride = 1 + beams.size() / round.most_beams;
    ranges = ranges_on_plate(beams, stride, triangle, PlateFrame(parameters, triangle.middle_m()));
    const auto chosen =
        edge_beams(beams, stride, triangle, parameters, ranges.offset_m, round.least_zone_m);
    fit.edge_beams = chosen.size();
    covariance = climb(chosen, triangle, before, round.converged, parameters, fit.misfit);
  }
  if (!covariance) return std::nullopt;
  fit.beta_rad = parameters[kBeta];
  fit.beta_sigma_rad = std::sqrt((*covariance)(kBeta, kBeta));
  fit.shape = shape_of(parameters, *covariance, ranges);
  fit.shape_information = covariance->block<5, 5>(kHeight, kHeight).inverse();
  fit.beta_by_shape = fit.shape_information * covariance->block<5, 1>(kHeight, kBeta);
  fit.residual_m = ranges.rms_m;
  fit.hits = ranges.hits;
  return fit;
}

}  // namespace swivel
