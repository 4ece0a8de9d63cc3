#include "calibration/alpha.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"

namespace swivel {
namespace {

constexpr std::array<const char*, kWalls> kWallNames = {"front", "left", "back", "right"};

// The four walls of one sweep, by Wall; null where there is none.
using FourWalls = std::array<const Plane*, kWalls>;

double turned(double angle_rad) {
  return std::remainder(angle_rad, 2 * kPi);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// The direction in O in which a wall's normal, which looks at the rig, should point.
double expected_azimuth_rad(std::size_t wall, const AlphaOptions& options) {
  return options.room_yaw_rad + static_cast<double>(wall) * kPi / 2 + kPi;
}

// Eq. (9): how far a wall of O' is off its place in O when the plate stands at alpha.
double wall_error_rad(const Plane& plane, std::size_t wall, double beta_rad, double alpha_rad,
                      const AlphaOptions& options) {
  return turned(plane.azimuth_rad() + alpha_rad - beta_rad - expected_azimuth_rad(wall, options));
}

// The largest wall of each side.
FourWalls sort_walls(const AlphaSweep& sweep, const AlphaOptions& options) {
  FourWalls sides{};
  for (const Plane& plane : sweep.walls) {
    for (std::size_t wall = 0; wall < kWalls; ++wall) {
      const double error_rad =
          wall_error_rad(plane, wall, sweep.beta_rad, options.initial_alpha_rad, options);
      if (std::abs(error_rad) > options.widest_skew_rad) continue;
      if (sides[wall] == nullptr || plane.points > sides[wall]->points) sides[wall] = &plane;
    }
  }
  return sides;
}

std::string missing_sides(const FourWalls& sides) {
  std::string names;
  for (std::size_t wall = 0; wall < kWalls; ++wall) {
    if (sides[wall] != nullptr) continue;
    names += names.empty() ? "" : ", ";
    names += kWallNames[wall];
  }
  return names;
}

std::string why_walls_are_missing(std::size_t number, const AlphaSweep& sweep,
                                  const FourWalls& sides, const AlphaOptions& options) {
  const auto found = static_cast<std::size_t>(
      std::count_if(sides.begin(), sides.end(), [](const Plane* wall) { return wall != nullptr; }));
  std::string reason =
      in_words("sweep ", number, ": ", found, " of 4 walls found, without ", missing_sides(sides));
  if (sweep.walls.size() > found) {
    reason += in_words("; ", sweep.walls.size() - found, " other upright planes are more than ",
                       spoken_deg(options.widest_skew_rad),
                       " deg off the rig's sides: set the rig square to the room, or give the "
                       "room's yaw");
  } else {
    reason += "; use a room with four plain walls in range";
  }
  return reason;
}

// Alpha as one sweep alone tells it, and how well.
struct SweepAlpha {
  double alpha_rad = 0.0;
  double sigma_rad = 0.0;
};

SweepAlpha alpha_of(const AlphaSweep& sweep, const FourWalls& sides, const AlphaOptions& options) {
  std::vector<double> errors_rad;
  double variance = 0.0;
  for (std::size_t wall = 0; wall < kWalls; ++wall) {
    errors_rad.push_back(
        wall_error_rad(*sides[wall], wall, sweep.beta_rad, options.initial_alpha_rad, options));
    variance += std::pow(sides[wall]->azimuth_sigma_rad / kWalls, 2);
  }
  return {options.initial_alpha_rad - median(errors_rad),
          std::hypot(sweep.beta_sigma_rad, std::sqrt(variance))};
}

// The robust loss is there for walls that are out of square. Where the sweeps themselves scatter
// by more, it must not take them for that.
AlphaOptions widened(const AlphaOptions& options, const std::vector<SweepAlpha>& alphas) {
  std::vector<double> values;
  values.reserve(alphas.size());
  for (const SweepAlpha& alpha : alphas) values.push_back(alpha.alpha_rad);
  const double middle_rad = median(values);
  for (double& value : values) value = std::abs(value - middle_rad);
  constexpr double kSdOfMedian = 1.4826;  // of absolute deviations, for a normal distribution
  AlphaOptions wider = options;
  wider.robust_scale_rad = std::max(options.robust_scale_rad, 2.0 * kSdOfMedian * median(values));
  return wider;
}

std::string why_sweeps_disagree(const std::vector<SweepAlpha>& alphas,
                                const AlphaOptions& options) {
  std::vector<double> values;
  values.reserve(alphas.size());
  for (const SweepAlpha& alpha : alphas) values.push_back(alpha.alpha_rad);
  const double middle_rad = median(values);
  std::size_t worst = 0;
  double worst_sigmas = 0.0;
  for (std::size_t sweep = 0; sweep < alphas.size(); ++sweep) {
    const double sigma_rad = std::max(alphas[sweep].sigma_rad, 1e-9);
    const double sigmas = std::abs(alphas[sweep].alpha_rad - middle_rad) / sigma_rad;
    if (sigmas > worst_sigmas) {
      worst = sweep;
      worst_sigmas = sigmas;
    }
  }
  if (worst_sigmas <= options.widest_sweep_sigmas) return {};
  return in_words("the sweeps disagree: sweep ", worst + 1, " is ",
                  spoken_deg(alphas[worst].alpha_rad - middle_rad), " deg off the median, ",
                  worst_sigmas, " times its sigma; see that rig and room stand still, then repeat");
}

// Signed, unlike eq. (11) of the paper, whose absolute value has no derivative where it matters.
struct WallResidual {
  double nx;  // the wall's horizontal normal in O', turned by -beta
  double ny;
  double expected_rad;

  template <typename Scalar>
  bool operator()(const Scalar* alpha_rad, Scalar* residual) const {
    const Scalar turn_rad = *alpha_rad - expected_rad;
    *residual = ceres::sin(turn_rad) * nx + ceres::cos(turn_rad) * ny;
    return true;
  }
};

using Sides = std::vector<FourWalls>;

void add_residuals(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                   const AlphaOptions& options, ceres::LossFunction* loss, double* alpha_rad,
                   ceres::Problem& problem) {
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    for (std::size_t wall = 0; wall < kWalls; ++wall) {
      const double azimuth_rad = sides[sweep][wall]->azimuth_rad() - sweeps[sweep].beta_rad;
      auto* cost = new ceres::AutoDiffCostFunction<WallResidual, 1, 1>(new WallResidual{
          std::cos(azimuth_rad), std::sin(azimuth_rad), expected_azimuth_rad(wall, options)});
      problem.AddResidualBlock(cost, loss, alpha_rad);
    }
  }
}

// Levenberg-Marquardt, with the loss or (null) without.
ceres::Solver::Summary solve(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                             const AlphaOptions& options, ceres::LossFunction* loss,
                             double& alpha_rad) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;  // all residuals share one
  ceres::Problem problem(ownership);
  add_residuals(sweeps, sides, options, loss, &alpha_rad, problem);
  ceres::Solver::Options solver;
  solver.minimizer_type = ceres::TRUST_REGION;
  solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.most_iterations;
  solver.function_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-11;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary;
}

double error_after_rad(const AlphaSweep& sweep, const FourWalls& sides, std::size_t wall,
                       double alpha_rad, const AlphaOptions& options) {
  return wall_error_rad(*sides[wall], wall, sweep.beta_rad, alpha_rad, options);
}

// The weight that the robust loss leaves to an error.
double weight(double error_rad, const AlphaOptions& options) {
  return 1.0 / (1.0 + std::pow(error_rad / options.robust_scale_rad, 2));
}

// Two sides of a 68 % interval of Student's t, over that of a normal distribution.
double small_sample_factor(std::size_t degrees_of_freedom) {
  const auto freedom = static_cast<double>(degrees_of_freedom);
  return 1.0 + 0.55 / freedom + 0.29 / (freedom * freedom);
}

// Eq. (11): the sweeps' scatter about the fit. The walls of one sweep share its beta and so
// count as one.
double scatter_sigma_rad(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                         double alpha_rad, const AlphaOptions& options) {
  double weights = 0.0;
  double squares = 0.0;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    double pull_rad = 0.0;
    for (std::size_t wall = 0; wall < kWalls; ++wall) {
      const double error_rad =
          error_after_rad(sweeps[sweep], sides[sweep], wall, alpha_rad, options);
      weights += weight(error_rad, options);
      pull_rad += weight(error_rad, options) * error_rad;
    }
    squares += pull_rad * pull_rad;
  }
  const auto count = static_cast<double>(sweeps.size());
  return small_sample_factor(sweeps.size() - 1) * std::sqrt(squares * count / (count - 1.0)) /
         weights;
}

// What the sweeps' own sigmas foretell for their mean.
double foretold_sigma_rad(const std::vector<SweepAlpha>& alphas) {
  double variance = 0.0;
  for (const SweepAlpha& alpha : alphas) variance += alpha.sigma_rad * alpha.sigma_rad;
  return std::sqrt(variance) / static_cast<double>(alphas.size());
}

// Eq. (12): walls that are not quite square stay so however many sweeps there are.
double walls_sigma_rad(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                       const AlphaFit& fit, const AlphaOptions& options) {
  double weights = 0.0;
  double squares = 0.0;
  for (std::size_t wall = 0; wall < kWalls; ++wall) {
    double noise = 0.0;  // variance of the wall's mean angle, from its points
    for (const FourWalls& four : sides) noise += std::pow(four[wall]->azimuth_sigma_rad, 2);
    noise /= static_cast<double>(sweeps.size() * sweeps.size());
    const double error_rad = fit.wall_angles_rad[wall];
    const double wall_weight = weight(error_rad, options);
    weights += wall_weight;
    squares += wall_weight * wall_weight * std::max(0.0, error_rad * error_rad - noise);
  }
  return std::sqrt(squares * kWalls / (kWalls - 1.0)) / weights;
}

void measure_errors(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                    const AlphaOptions& options, AlphaFit& fit) {
  const auto count = static_cast<double>(sweeps.size());
  double squares = 0.0;
  for (std::size_t wall = 0; wall < kWalls; ++wall) {
    double sum_rad = 0.0;
    for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
      const double error_rad =
          error_after_rad(sweeps[sweep], sides[sweep], wall, fit.alpha_rad, options);
      sum_rad += error_rad;
      squares += error_rad * error_rad;
    }
    fit.wall_angles_rad[wall] = sum_rad / count;
  }
  fit.residual_rms_rad = std::sqrt(squares / (kWalls * count));
}

std::string why_room_is_skewed(const AlphaFit& fit, const AlphaOptions& options) {
  for (std::size_t one = 0; one < kWalls; ++one) {
    for (std::size_t other = one + 1; other < kWalls; ++other) {
      const double off_rad = fit.wall_angles_rad[one] - fit.wall_angles_rad[other];
      if (std::abs(off_rad) <= options.widest_corner_rad) continue;
      return in_words("the ", kWallNames[one], " and ", kWallNames[other], " walls are ",
                      spoken_deg(std::abs(off_rad)),
                      " deg off square to each other: use a room with square corners");
    }
  }
  return {};
}

// First without the robust loss, from anywhere; then with it, from there.
AlphaFit fit_walls(const std::vector<AlphaSweep>& sweeps, const Sides& sides,
                   const std::vector<SweepAlpha>& alphas, const AlphaOptions& options) {
  AlphaFit fit;
  fit.alpha_rad = options.initial_alpha_rad;
  const auto plain = solve(sweeps, sides, options, nullptr, fit.alpha_rad);
  ceres::CauchyLoss robust_loss(options.robust_scale_rad);
  const auto robust = solve(sweeps, sides, options, &robust_loss, fit.alpha_rad);
  fit.iterations = static_cast<int>(plain.iterations.size() + robust.iterations.size());
  fit.converged =
      plain.termination_type == ceres::CONVERGENCE && robust.termination_type == ceres::CONVERGENCE;
  fit.sweeps_used = sweeps.size();
  measure_errors(sweeps, sides, options, fit);
  const double noise_rad = std::max(scatter_sigma_rad(sweeps, sides, fit.alpha_rad, options),
                                    foretold_sigma_rad(alphas));
  fit.sigma_rad = std::hypot(noise_rad, walls_sigma_rad(sweeps, sides, fit, options));
  return fit;
}

std::string why_input_is_useless(const std::vector<AlphaSweep>& sweeps,
                                 const AlphaOptions& options) {
  const std::size_t least =
      std::max<std::size_t>(2, options.least_sweeps);  // or there is no scatter
  if (sweeps.size() < least) {
    return in_words("only ", sweeps.size(), " sweeps of the ", least, " needed at least");
  }
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    if (!std::isfinite(sweeps[sweep].beta_rad) || !std::isfinite(sweeps[sweep].beta_sigma_rad)) {
      return in_words("sweep ", sweep + 1, " has no attitude: leave it out");
    }
  }
  return {};
}

}  // namespace

AlphaResult fit_alpha(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options) {
  const std::string useless = why_input_is_useless(sweeps, options);
  if (!useless.empty()) return {std::nullopt, useless};
  Sides sides;
  std::vector<SweepAlpha> alphas;
  for (const AlphaSweep& sweep : sweeps) {
    sides.push_back(sort_walls(sweep, options));
    if (!missing_sides(sides.back()).empty()) {
      return {std::nullopt, why_walls_are_missing(sides.size(), sweep, sides.back(), options)};
    }
    alphas.push_back(alpha_of(sweep, sides.back(), options));
  }
  const std::string disagreement = why_sweeps_disagree(alphas, options);
  if (!disagreement.empty()) return {std::nullopt, disagreement};
  const AlphaFit fit = fit_walls(sweeps, sides, alphas, widened(options, alphas));
  const std::string skewed = why_room_is_skewed(fit, options);
  if (!skewed.empty()) return {std::nullopt, skewed};
  if (!fit.converged) {
    return {std::nullopt, in_words("the fit did not converge in ", fit.iterations, " iterations")};
  }
  return {fit, ""};
}

}  // namespace swivel
