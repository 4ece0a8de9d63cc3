#include "calibration/symmetric_rays.hpp"

#include <ceres/tiny_solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "calibration/in_words.hpp"
#include "calibration/ray_pairs.hpp"

namespace swivel {
namespace {

constexpr double kMostTiltOfCentreline = 0.17;  // sine: 10 deg
constexpr std::size_t kFewestPairs = 200;
constexpr double kKeptHeightScatters = 3.5;
constexpr int kSelections = 6;
constexpr double kAgreedRad = rad_from_deg(0.01);
constexpr double kAgreedSigmas = 3.0;
constexpr double kMostAgreedRad = rad_from_deg(0.05);  // lines that scatter by more do not agree

// Bias, and the slopes of the surface along X and Y of the axis frame.
using RayUnknowns = Eigen::Vector3d;

double bent_by_rad(const RayPair& pair, const RayUnknowns& unknowns) {
  return unknowns[0] + unknowns[1] * std::cos(pair.axis_angle_rad) +
         unknowns[2] * std::sin(pair.axis_angle_rad);
}

// Eq. (21), over the sigma that range noise gives it.
double height_difference(const RayPair& pair, double bend_rad) {
  const double first = std::cos(pair.first_rad + bend_rad);
  const double second = std::cos(pair.second_rad + bend_rad);
  return (pair.first_m * first - pair.second_m * second) / std::hypot(first, second);
}

double difference_by_bend(const RayPair& pair, double bend_rad) {
  const double first = std::cos(pair.first_rad + bend_rad);
  const double second = std::cos(pair.second_rad + bend_rad);
  return (pair.second_m * std::sin(pair.second_rad + bend_rad) -
          pair.first_m * std::sin(pair.first_rad + bend_rad)) /
         std::hypot(first, second);
}

RayUnknowns difference_by_unknowns(const RayPair& pair, const RayUnknowns& unknowns) {
  return difference_by_bend(pair, bent_by_rad(pair, unknowns)) *
         RayUnknowns(1.0, std::cos(pair.axis_angle_rad), std::sin(pair.axis_angle_rad));
}

// For Ceres: the differences of all pairs, by the first one or all three of the unknowns.
struct HeightDifferences {
  using Scalar = double;
  // NOLINTBEGIN(readability-identifier-naming): Ceres asks for these names
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  const RayPairs& pairs;
  int unknowns;

  int NumResiduals() const { return static_cast<int>(pairs.size()); }
  int NumParameters() const { return unknowns; }
  // NOLINTEND(readability-identifier-naming)

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    RayUnknowns values = RayUnknowns::Zero();
    std::copy_n(parameters, unknowns, values.data());
    for (std::size_t index = 0; index < pairs.size(); ++index) {
      residuals[index] = height_difference(pairs[index], bent_by_rad(pairs[index], values));
      if (jacobian == nullptr) continue;
      const RayUnknowns row = difference_by_unknowns(pairs[index], values);
      for (int column = 0; column < unknowns; ++column) {
        jacobian[static_cast<std::size_t>(column) * pairs.size() + index] = row[column];
      }
    }
    return true;
  }
};

RayUnknowns minimise(const RayPairs& pairs, RayUnknowns start, int unknowns) {
  HeightDifferences differences{pairs, unknowns};
  ceres::TinySolver<HeightDifferences> solver;
  Eigen::VectorXd values = start.head(unknowns);
  solver.Solve(differences, &values);
  RayUnknowns found = RayUnknowns::Zero();
  found.head(unknowns) = values;
  return found;
}

// What the beam angle is when the beam points along the axis, with the sign turned.
std::optional<double> centreline_rad(const RigGeometry& rig) {
  const Eigen::Matrix3d R = rig.T_axis_lidar.linear();
  if (std::abs(R(2, 0)) > kMostTiltOfCentreline) return std::nullopt;
  if (std::abs(R(2, 2)) < 1.0 - kMostTiltOfCentreline * kMostTiltOfCentreline) return std::nullopt;
  return rig.bias_rad - std::atan2(R(2, 1), R(2, 2));
}

double scatter_m(const RayPairs& pairs, const RayUnknowns& unknowns) {
  std::vector<double> sizes_m;
  sizes_m.reserve(pairs.size());
  for (const RayPair& pair : pairs) {
    sizes_m.push_back(std::abs(height_difference(pair, bent_by_rad(pair, unknowns))));
  }
  const auto middle = sizes_m.begin() + static_cast<std::ptrdiff_t>(sizes_m.size() / 2);
  std::nth_element(sizes_m.begin(), middle, sizes_m.end());
  return 1.4826 * *middle;
}

RayPairs without_outliers(const RayPairs& pairs, const RayUnknowns& unknowns) {
  const double most_m = kKeptHeightScatters * scatter_m(pairs, unknowns);
  RayPairs kept;
  for (const RayPair& pair : pairs) {
    if (std::abs(height_difference(pair, bent_by_rad(pair, unknowns))) <= most_m)
      kept.push_back(pair);
  }
  return kept;
}

struct RaysOfHalf {
  RayUnknowns unknowns = RayUnknowns::Zero();
  RayPairs used;
};

RaysOfHalf fit_half(const RayPairs& pairs, int unknowns) {
  RaysOfHalf fit{RayUnknowns::Zero(), pairs};
  for (int selection = 0; selection < kSelections; ++selection) {
    fit.unknowns = minimise(fit.used, fit.unknowns, unknowns);
    fit.used = without_outliers(pairs, fit.unknowns);
  }
  return fit;
}

// Lines err together, so each speaks once: the sandwich of the normal equations.
double sigma_of_bias_rad(const RaysOfHalf& fit, int unknowns) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(unknowns, unknowns);
  std::map<std::size_t, Eigen::VectorXd> of_lines;
  for (const RayPair& pair : fit.used) {
    const Eigen::VectorXd row = difference_by_unknowns(pair, fit.unknowns).head(unknowns);
    information += row * row.transpose();
    auto& sum = of_lines.try_emplace(pair.line, Eigen::VectorXd::Zero(unknowns)).first->second;
    sum += row * height_difference(pair, bent_by_rad(pair, fit.unknowns));
  }
  const Eigen::VectorXd first = information.ldlt().solve(Eigen::VectorXd::Unit(unknowns, 0));
  double variance = 0.0;
  for (const auto& [line, sum] : of_lines) variance += std::pow(first.dot(sum), 2);
  return std::sqrt(variance);
}

// By how much the bias of the second half is another, the lean being known: its line error.
double off_rad(const RayPairs& second, const RayUnknowns& unknowns) {
  double numerator = 0.0;
  double denominator = 0.0;
  for (const RayPair& pair : without_outliers(second, unknowns)) {
    const double bend_rad = bent_by_rad(pair, unknowns);
    const double slope = difference_by_bend(pair, bend_rad);
    numerator -= slope * height_difference(pair, bend_rad);
    denominator += slope * slope;
  }
  return numerator / denominator;
}

}  // namespace

SymmetricRaysFit fit_symmetric_rays(const SweepReadings& readings, const RigGeometry& nominal) {
  SymmetricRaysFit fit;
  const auto centreline = centreline_rad(nominal);
  if (!centreline) {
    fit.reason = "the lidar's centreline does not lie along the axis";
    return fit;
  }
  RayPairs first = on_roof_or_floor(pairs_of(readings, *centreline));
  const auto middle = std::stable_partition(first.begin(), first.end(), [&](const RayPair& pair) {
    return 2 * pair.line < readings.lines.size();
  });
  const RayPairs second(middle, first.end());
  first.erase(middle, first.end());
  if (first.size() < kFewestPairs || second.size() < kFewestPairs) {
    fit.reason = "no roof and no floor is seen on both sides of the axis";
    return fit;
  }
  for (const int unknowns : {1, 3}) {  // again with a surface that leans, if the first fails
    const RaysOfHalf half = fit_half(first, unknowns);
    fit.sigma_rad = sigma_of_bias_rad(half, unknowns);
    fit.bias_rad = nominal.bias_rad + half.unknowns[0];
    fit.lean_rad = half.unknowns.tail<2>().norm();
    fit.pairs = half.used.size();
    fit.second_half_off_rad = off_rad(second, half.unknowns);
    ++fit.attempts;
    const double chance_rad = kAgreedSigmas * std::sqrt(2.0) * fit.sigma_rad;
    fit.verified =
        std::abs(fit.second_half_off_rad) < std::clamp(chance_rad, kAgreedRad, kMostAgreedRad);
    if (fit.verified) return fit;
  }
  fit.reason = in_words("the second half of the sweep differs by ",
                        spoken_deg(fit.second_half_off_rad), " deg: roof or floor is not flat");
  return fit;
}

}  // namespace swivel
