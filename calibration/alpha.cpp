#include "calibration/alpha.hpp"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"
#include "calibration/room_walls.hpp"

namespace swivel {
namespace {

constexpr double kMisfitSigmas = 5.0;  // of one wall in one sweep: it was something else
constexpr double kLeastMisfitRad = rad_from_deg(0.05);
constexpr double kLeastSigmaRad = 1e-6;                  // what claims less still has rounding
constexpr double kUncheckedWallRad = rad_from_deg(0.1);  // how square a wall is, as walls are
constexpr double kAsDrawnRad = rad_from_deg(5.0);        // a plate is mounted no worse than that
constexpr double kNamedWallRad = rad_from_deg(0.2);      // a wall off square by more is named
constexpr double kNoLossRad = 10.0;                      // a robust scale beyond any angle
constexpr double kOneInAThousand = 3.09;                 // in sigmas, one side

// One wall in one sweep: by how much it is off its place if the plate stood as drawn.
struct Sighting {
  std::size_t wall;  // index into RoomWalls::walls
  double error_rad;
  double variance;  // of its normal; what beta adds is common to the sweep
};

struct SweepView {
  std::size_t number;  // from 1, as the caller counts
  double beta_variance;
  std::vector<Sighting> sightings;
};
using Views = std::vector<SweepView>;

// The walls' own angles in the plate's frame, by generalised least squares.
struct WallAngles {
  Eigen::VectorXd error_rad;
  Eigen::MatrixXd covariance;
};

// What a sweep's walls are off together: its beta's error.
struct Common {
  double error_rad;
  double variance;
};

Views views_of(const std::vector<AlphaSweep>& sweeps, const RoomWalls& room,
               const AlphaOptions& options) {
  Views views;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    const AlphaSweep& seen = sweeps[sweep];
    const double beta_sigma_rad = std::max(seen.beta_sigma_rad, kLeastSigmaRad);
    SweepView view{sweep + 1, beta_sigma_rad * beta_sigma_rad, {}};
    for (std::size_t wall = 0; wall < room.walls.size(); ++wall) {
      const Plane* const plane = room.walls[wall].by_sweep[sweep];
      if (plane == nullptr) continue;
      const double sigma_rad = std::max(plane->azimuth_sigma_rad, kLeastSigmaRad);
      view.sightings.push_back({wall,
                                wall_error_rad(*plane, room.walls[wall].side, seen.beta_rad,
                                               options.initial_alpha_rad, options),
                                sigma_rad * sigma_rad});
    }
    views.push_back(view);
  }
  return views;
}

// What saw no wall tells nothing.
std::string leave_out_blind(Views& views) {
  std::string numbers;
  for (const SweepView& view : views) {
    if (view.sightings.empty()) numbers += in_words(numbers.empty() ? "" : ", ", view.number);
  }
  const auto blind = [](const SweepView& view) { return view.sightings.empty(); };
  views.erase(std::remove_if(views.begin(), views.end(), blind), views.end());
  return numbers.empty() ? "" : "left out, none of the room's walls seen: sweep " + numbers;
}

// Of the errors of one sweep's walls, which share its beta.
Eigen::MatrixXd covariance_of(const SweepView& view) {
  const auto count = static_cast<Eigen::Index>(view.sightings.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(count, count, view.beta_variance);
  for (Eigen::Index index = 0; index < count; ++index) {
    covariance(index, index) += view.sightings[static_cast<std::size_t>(index)].variance;
  }
  return covariance;
}

// Eq. (9).
WallAngles fit_wall_angles(const Views& views, std::size_t walls) {
  const auto count = static_cast<Eigen::Index>(walls);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(count);
  for (const SweepView& view : views) {
    const Eigen::MatrixXd weights = covariance_of(view).inverse();
    for (Eigen::Index row = 0; row < weights.rows(); ++row) {
      const auto wall =
          static_cast<Eigen::Index>(view.sightings[static_cast<std::size_t>(row)].wall);
      for (Eigen::Index column = 0; column < weights.cols(); ++column) {
        const Sighting& other = view.sightings[static_cast<std::size_t>(column)];
        information(wall, static_cast<Eigen::Index>(other.wall)) += weights(row, column);
        pull(wall) += weights(row, column) * other.error_rad;
      }
    }
  }
  const Eigen::MatrixXd covariance = information.inverse();
  return {covariance * pull, covariance};
}

double off_rad(const Sighting& sighting, const WallAngles& angles) {
  return sighting.error_rad - angles.error_rad(static_cast<Eigen::Index>(sighting.wall));
}

Common common_of(const SweepView& view, const WallAngles& angles) {
  double weights = 0.0;
  double sum = 0.0;
  for (const Sighting& sighting : view.sightings) {
    weights += 1.0 / sighting.variance;
    sum += off_rad(sighting, angles) / sighting.variance;
  }
  return {sum / weights, view.beta_variance + 1.0 / weights};
}

std::size_t sightings_of(const Views& views, std::size_t wall) {
  std::size_t count = 0;
  for (const SweepView& view : views) {
    for (const Sighting& sighting : view.sightings) count += sighting.wall == wall ? 1 : 0;
  }
  return count;
}

// The sighting that fits worst to its sweep's others and its wall's others, taken out if it is
// no chance. Two of a wall do not tell which of them is wrong.
bool take_out_worst(Views& views, const WallAngles& angles, const RoomWalls& room,
                    std::vector<std::string>& remarks) {
  double worst_sigmas = kMisfitSigmas;
  SweepView* worst_view = nullptr;
  std::size_t worst = 0;
  for (SweepView& view : views) {
    const double common_rad = common_of(view, angles).error_rad;
    for (std::size_t index = 0; index < view.sightings.size(); ++index) {
      const Sighting& sighting = view.sightings[index];
      const double misfit_rad = std::abs(off_rad(sighting, angles) - common_rad);
      const double sigmas = misfit_rad / std::sqrt(sighting.variance);
      if (misfit_rad < kLeastMisfitRad || sigmas < worst_sigmas) continue;
      if (view.sightings.size() < 2 || sightings_of(views, sighting.wall) < 3) continue;
      worst_sigmas = sigmas;
      worst_view = &view;
      worst = index;
    }
  }
  if (worst_view == nullptr) return false;
  const std::size_t side = room.walls[worst_view->sightings[worst].wall].side;
  remarks.push_back(in_words("left out, unlike what the other sweeps saw: the ", kWallNames[side],
                             " wall in sweep ", worst_view->number));
  worst_view->sightings.erase(worst_view->sightings.begin() + static_cast<std::ptrdiff_t>(worst));
  return true;
}

std::string why_sweeps_disagree(const Views& views, const WallAngles& angles,
                                const AlphaOptions& options) {
  std::vector<double> errors_rad;
  double variance = 0.0;
  for (const SweepView& view : views) {
    errors_rad.push_back(common_of(view, angles).error_rad);
    variance += common_of(view, angles).variance;
  }
  const auto count = static_cast<double>(views.size());
  const double median_variance = kPi / 2.0 * variance / (count * count);
  const double middle_rad = median(errors_rad);
  double worst_sigmas = 0.0;
  std::string reason;
  for (const SweepView& view : views) {
    const Common common = common_of(view, angles);
    const double error_rad = middle_rad - common.error_rad;  // of alpha
    const double sigmas = std::abs(error_rad) / std::sqrt(common.variance + median_variance);
    if (sigmas <= std::max(worst_sigmas, options.widest_sweep_sigmas)) continue;
    worst_sigmas = sigmas;
    reason = in_words("the sweeps disagree: sweep ", view.number, " is ", spoken_deg(error_rad),
                      " deg off the median, ", sigmas,
                      " times its sigma; see that rig and room stand still, then repeat");
  }
  return reason;
}

// Signed, unlike eq. (11) of the paper, whose absolute value has no derivative where it matters.
struct WallResidual {
  double error_rad;  // if alpha were as drawn
  double initial_alpha_rad;
  double scale_rad;

  template <typename Scalar>
  bool operator()(const Scalar* alpha_rad, Scalar* residual) const {
    *residual = ceres::sin(*alpha_rad - initial_alpha_rad + error_rad) / scale_rad;
    return true;
  }
};

// Of a wall's mean angle, by its normals alone.
std::vector<double> normal_variances(const Views& views, std::size_t walls) {
  std::vector<double> information(walls, 0.0);
  for (const SweepView& view : views) {
    for (const Sighting& sighting : view.sightings) {
      information[sighting.wall] += 1.0 / sighting.variance;
    }
  }
  for (double& value : information) value = 1.0 / value;
  return information;
}

// Within this a wall's angle is no news: its noise, and how well walls are built.
double wall_scale_rad(double normal_variance, const AlphaOptions& options) {
  return std::sqrt(normal_variance + options.wall_floor_rad * options.wall_floor_rad);
}

// Levenberg-Marquardt over the walls' angles. The walls agree by some degrees, as find_room_walls
// saw to; the loss then lets go of one that does not.
ceres::Solver::Summary solve(const WallAngles& angles, const std::vector<double>& variances,
                             const AlphaOptions& options, ceres::LossFunction* loss,
                             double& alpha_rad) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;  // all residuals share one
  ceres::Problem problem(ownership);
  for (std::size_t wall = 0; wall < variances.size(); ++wall) {
    auto* cost = new ceres::AutoDiffCostFunction<WallResidual, 1, 1>(
        new WallResidual{angles.error_rad(static_cast<Eigen::Index>(wall)),
                         options.initial_alpha_rad, wall_scale_rad(variances[wall], options)});
    problem.AddResidualBlock(cost, loss, &alpha_rad);
  }
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

// Two walls do not tell which of them is askew, so no loss may choose.
AlphaOptions with_loss_for(std::size_t walls, AlphaOptions options) {
  if (walls < 3) options.robust_scale_rad = kNoLossRad;
  return options;
}

// From the middle of the walls: the loss has other valleys, farther off.
AlphaFit fit_walls(const WallAngles& angles, const std::vector<double>& variances,
                   const AlphaOptions& options) {
  AlphaFit fit;
  const std::vector<double> errors_rad(angles.error_rad.begin(), angles.error_rad.end());
  fit.alpha_rad = options.initial_alpha_rad - median(errors_rad);
  ceres::CauchyLoss loss(options.robust_scale_rad / options.wall_floor_rad);
  const auto summary = solve(angles, variances, options, &loss, fit.alpha_rad);
  fit.iterations = static_cast<int>(summary.iterations.size());
  fit.converged = summary.termination_type == ceres::CONVERGENCE;
  return fit;
}

// The share of each wall in alpha, as the loss leaves it.
Eigen::VectorXd shares(const Eigen::VectorXd& wall_errors_rad, const std::vector<double>& variances,
                       const AlphaOptions& options) {
  Eigen::VectorXd weights(wall_errors_rad.size());
  const double loss_scale = options.robust_scale_rad / options.wall_floor_rad;
  for (Eigen::Index wall = 0; wall < weights.size(); ++wall) {
    const double scale_rad = wall_scale_rad(variances[static_cast<std::size_t>(wall)], options);
    const double error = wall_errors_rad(wall) / (scale_rad * loss_scale);
    weights(wall) = 1.0 / (scale_rad * scale_rad * (1.0 + error * error));
  }
  return weights / weights.sum();
}

// Eq. (12): walls that are not quite square stay so however many sweeps there are. Four that
// agree tell how square they are; three, or four of which one counts for nothing, nearly so; two
// do not.
double walls_sigma_rad(const Eigen::VectorXd& wall_errors_rad, const Eigen::VectorXd& shares,
                       const std::vector<double>& variances) {
  double squares = 0.0;
  for (Eigen::Index wall = 0; wall < shares.size(); ++wall) {
    const double noise = variances[static_cast<std::size_t>(wall)];
    const double skew = std::max(0.0, wall_errors_rad(wall) * wall_errors_rad(wall) - noise);
    squares += shares(wall) * shares(wall) * skew;
  }
  const auto count = static_cast<double>(shares.size());
  const double heard = 1.0 / shares.squaredNorm();  // walls, as if all counted for as much
  const double unheard = std::max(0.0, kWalls - heard) / heard;
  return std::sqrt(squares * count / (count - 1.0) +
                   kUncheckedWallRad * kUncheckedWallRad * std::pow(unheard, 3));
}

struct ChiSquare {
  double sum = 0.0;
  double freedom = 0.0;

  // Sigmas are widened by as much as the scatter is more than they foretell.
  double widening() const { return freedom > 0.0 ? std::max(1.0, std::sqrt(sum / freedom)) : 1.0; }

  // Wilson and Hilferty's: the cube root is nearly normal.
  bool by_chance() const {
    if (freedom <= 0.0) return true;
    const double variance = 2.0 / (9.0 * freedom);
    return std::cbrt(sum / freedom) <= 1.0 - variance + kOneInAThousand * std::sqrt(variance);
  }
};

// Eq. (11): of the sweeps about the fit, by their betas.
ChiSquare scatter_of_sweeps(const Views& views, const WallAngles& angles) {
  ChiSquare chi{0.0, static_cast<double>(views.size()) - 1.0};
  for (const SweepView& view : views) {
    const Common common = common_of(view, angles);
    chi.sum += common.error_rad * common.error_rad / common.variance;
  }
  return chi;
}

// Of the walls within each sweep, by their normals.
ChiSquare scatter_of_walls(const Views& views, const WallAngles& angles) {
  ChiSquare chi{0.0, 1.0 - static_cast<double>(angles.error_rad.size())};
  for (const SweepView& view : views) {
    const double common_rad = common_of(view, angles).error_rad;
    chi.freedom += static_cast<double>(view.sightings.size()) - 1.0;
    for (const Sighting& sighting : view.sightings) {
      const double error_rad = off_rad(sighting, angles) - common_rad;
      chi.sum += error_rad * error_rad / sighting.variance;
    }
  }
  return chi;
}

void test_model(const ChiSquare& sweeps, const ChiSquare& walls, AlphaFit& fit) {
  const ChiSquare all{sweeps.sum + walls.sum, sweeps.freedom + walls.freedom};
  fit.chi_square = all.sum;
  fit.degrees_of_freedom = static_cast<std::size_t>(all.freedom);
  fit.model_holds = all.by_chance() && sweeps.by_chance() && walls.by_chance();
  if (fit.model_holds) return;
  const char* const who = sweeps.by_chance() ? "the walls' angles" : "the plate's azimuths";
  fit.remarks.push_back(
      in_words(who, " scatter more over the sweeps than their sigmas foretell ", "(chi-square ",
               fit.chi_square, " of ", fit.degrees_of_freedom,
               " degrees of freedom), so sigma is widened: see that rig, room and "
               "plate stand still"));
}

void measure_errors(const Views& views, const WallAngles& angles, const RoomWalls& room,
                    const AlphaOptions& options, AlphaFit& fit) {
  const double moved_rad = fit.alpha_rad - options.initial_alpha_rad;
  fit.wall_angles_rad.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t wall = 0; wall < room.walls.size(); ++wall) {
    const double angle_rad = angles.error_rad(static_cast<Eigen::Index>(wall)) + moved_rad;
    fit.wall_angles_rad[room.walls[wall].side] = angle_rad;
    if (std::abs(angle_rad) < kNamedWallRad) continue;
    fit.remarks.push_back(in_words("the ", kWallNames[room.walls[wall].side], " wall is ",
                                   spoken_deg(angle_rad), " deg off square and counts for little"));
  }
  double squares = 0.0;
  double count = 0.0;
  for (const SweepView& view : views) {
    count += static_cast<double>(view.sightings.size());
    for (const Sighting& sighting : view.sightings) {
      squares += std::pow(sighting.error_rad + moved_rad, 2);
    }
  }
  fit.residual_rms_rad = std::sqrt(squares / count);
}

void measure_sigma(const Views& views, const WallAngles& angles,
                   const std::vector<double>& variances, const AlphaOptions& options,
                   AlphaFit& fit) {
  const double moved_rad = fit.alpha_rad - options.initial_alpha_rad;
  const Eigen::VectorXd errors_rad = angles.error_rad.array() + moved_rad;
  const Eigen::VectorXd share = shares(errors_rad, variances, options);
  const ChiSquare sweeps = scatter_of_sweeps(views, angles);
  const ChiSquare walls = scatter_of_walls(views, angles);
  test_model(sweeps, walls, fit);
  fit.sweeps_sigma_rad = sweeps.widening() * std::sqrt(share.dot(angles.covariance * share));
  fit.walls_sigma_rad = walls_sigma_rad(errors_rad, share, variances);
  fit.sigma_rad = std::hypot(fit.sweeps_sigma_rad, fit.walls_sigma_rad);
}

std::string why_input_is_useless(const std::vector<AlphaSweep>& sweeps) {
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    if (!std::isfinite(sweeps[sweep].beta_rad) || !std::isfinite(sweeps[sweep].beta_sigma_rad)) {
      return in_words("sweep ", sweep + 1, " has no attitude: leave it out");
    }
  }
  return {};
}

std::string why_too_few(std::size_t sweeps, const AlphaOptions& options) {
  const std::size_t least = std::max<std::size_t>(1, options.least_sweeps);
  if (sweeps >= least) return {};
  return in_words("only ", sweeps, " sweeps of the ", least, " needed at least");
}

void doubt(const AlphaOptions& options, AlphaFit& fit) {
  if (fit.sweeps_used < 2) {
    fit.remarks.emplace_back("one sweep cannot show whether its plate was found rightly");
  }
  const double moved_rad = fit.alpha_rad - options.initial_alpha_rad;
  if (std::abs(moved_rad) < kAsDrawnRad) return;
  fit.remarks.push_back(in_words("alpha is ", spoken_deg(moved_rad),
                                 " deg off the drawing: does the rig stand square in the room?"));
}

AlphaResult refused(const std::string& reason) {
  return {std::nullopt, reason};
}

}  // namespace

AlphaResult fit_alpha(const std::vector<AlphaSweep>& sweeps, const AlphaOptions& options) {
  if (const auto why = why_input_is_useless(sweeps); !why.empty()) return refused(why);
  if (const auto why = why_too_few(sweeps.size(), options); !why.empty()) return refused(why);
  const RoomWalls room = find_room_walls(sweeps, options);
  if (!room.reason.empty()) return refused(room.reason);
  std::vector<std::string> remarks = room.remarks;
  Views views = views_of(sweeps, room, options);
  if (const auto blind = leave_out_blind(views); !blind.empty()) {
    if (const auto why = why_too_few(views.size(), options); !why.empty())
      return refused(why + "; " + blind);
    remarks.push_back(blind);
  }
  WallAngles angles = fit_wall_angles(views, room.walls.size());
  while (take_out_worst(views, angles, room, remarks)) {
    angles = fit_wall_angles(views, room.walls.size());
  }
  if (const auto why = why_sweeps_disagree(views, angles, options); !why.empty())
    return refused(why);
  const std::vector<double> variances = normal_variances(views, room.walls.size());
  const AlphaOptions heard = with_loss_for(room.walls.size(), options);
  AlphaFit fit = fit_walls(angles, variances, heard);
  fit.sweeps_used = views.size();
  fit.remarks = remarks;
  measure_errors(views, angles, room, options, fit);
  measure_sigma(views, angles, variances, heard, fit);
  doubt(options, fit);
  if (fit.converged) return {fit, ""};
  return refused(in_words("the fit did not converge in ", fit.iterations, " iterations"));
}

std::optional<std::size_t> more_sweeps_for(const AlphaFit& fit, double sigma_rad) {
  if (fit.sigma_rad <= sigma_rad) return 0;
  if (fit.walls_sigma_rad >= sigma_rad) return std::nullopt;
  const double left_rad =
      std::sqrt(sigma_rad * sigma_rad - fit.walls_sigma_rad * fit.walls_sigma_rad);
  const double times = std::pow(fit.sweeps_sigma_rad / left_rad, 2);
  const double needed = std::ceil(times * static_cast<double>(fit.sweeps_used) - 1e-9);
  return static_cast<std::size_t>(needed) - fit.sweeps_used;
}

}  // namespace swivel
