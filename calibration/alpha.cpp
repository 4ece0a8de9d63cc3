#include "calibration/alpha.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"
#include "calibration/wall_angles.hpp"

namespace swivel {
namespace {

constexpr double kUncheckedWallRad = rad_from_deg(0.1);  // how square a wall is, as walls are
constexpr double kAsDrawnRad = rad_from_deg(5.0);        // a plate is mounted no worse than that
constexpr double kNamedWallRad = rad_from_deg(0.2);      // a wall off square by more is named
constexpr double kNoLossRad = 10.0;                      // a robust scale beyond any angle

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

// Within this a wall's angle is no news: its noise, and how well walls are built.
double wall_scale_rad(double normal_variance, const AlphaOptions& options) {
  return std::sqrt(normal_variance + options.wall_floor_rad * options.wall_floor_rad);
}

// Geman and McClure's: a wall that is off by some scales is let go of altogether. Cauchy's would
// let one that is half a degree off turn alpha by 0.006 deg.
class LettingGo : public ceres::LossFunction {
 public:
  explicit LettingGo(double scale) : square_(scale * scale) {}
  void Evaluate(double s, double out[3]) const override {
    const double kept = square_ / (square_ + s);
    out[0] = s * kept;
    out[1] = kept * kept;
    out[2] = -2.0 * kept * kept * kept / square_;
  }

 private:
  double square_;
};

// Levenberg-Marquardt over the walls' angles. The walls agree by some degrees, as find_room_walls
// saw to; the loss then lets go of one that does not.
ceres::Solver::Summary solve(const WallAngles& angles, const AlphaOptions& options, LettingGo& loss,
                             double& alpha_rad) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;  // all residuals share one
  ceres::Problem problem(ownership);
  for (Eigen::Index wall = 0; wall < angles.error_rad.size(); ++wall) {
    auto* cost = new ceres::AutoDiffCostFunction<WallResidual, 1, 1>(
        new WallResidual{angles.error_rad(wall), options.initial_alpha_rad,
                         wall_scale_rad(angles.normal_variance(wall), options)});
    problem.AddResidualBlock(cost, &loss, &alpha_rad);
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
AlphaFit fit_walls(const WallAngles& angles, const AlphaOptions& options) {
  AlphaFit fit;
  const std::vector<double> errors_rad(angles.error_rad.begin(), angles.error_rad.end());
  fit.alpha_rad = options.initial_alpha_rad - median(errors_rad);
  LettingGo loss(options.robust_scale_rad / options.wall_floor_rad);
  const auto summary = solve(angles, options, loss, fit.alpha_rad);
  fit.iterations = static_cast<int>(summary.iterations.size());
  fit.converged = summary.termination_type == ceres::CONVERGENCE;
  return fit;
}

// The share of each wall in alpha, as the loss leaves it.
Eigen::VectorXd shares(const Eigen::VectorXd& wall_errors_rad, const Eigen::VectorXd& variances,
                       const AlphaOptions& options) {
  Eigen::VectorXd weights(wall_errors_rad.size());
  const double loss_scale = options.robust_scale_rad / options.wall_floor_rad;
  for (Eigen::Index wall = 0; wall < weights.size(); ++wall) {
    const double scale_rad = wall_scale_rad(variances(wall), options);
    const double error = wall_errors_rad(wall) / (scale_rad * loss_scale);
    weights(wall) = std::pow(scale_rad * (1.0 + error * error), -2);
  }
  return weights / weights.sum();
}

// Eq. (12): walls that are not quite square stay so however many sweeps there are. Four that
// agree tell how square they are; three, or four of which one counts for nothing, nearly so; two
// do not.
double walls_sigma_rad(const Eigen::VectorXd& wall_errors_rad, const Eigen::VectorXd& shares,
                       const Eigen::VectorXd& variances) {
  double squares = 0.0;
  for (Eigen::Index wall = 0; wall < shares.size(); ++wall) {
    const double noise = variances(wall);
    const double skew = std::max(0.0, wall_errors_rad(wall) * wall_errors_rad(wall) - noise);
    squares += shares(wall) * shares(wall) * skew;
  }
  const auto count = static_cast<double>(shares.size());
  const double heard = 1.0 / shares.squaredNorm();  // walls, as if all counted for as much
  const double unheard = std::max(0.0, kWalls - heard) / heard;
  return std::sqrt(squares * count / (count - 1.0) +
                   kUncheckedWallRad * kUncheckedWallRad * std::pow(unheard, 4));
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
    for (const WallSighting& sighting : view.sightings) {
      squares += std::pow(sighting.error_rad + moved_rad, 2);
    }
  }
  fit.residual_rms_rad = std::sqrt(squares / count);
}

void measure_sigma(const Views& views, const WallAngles& angles, const AlphaOptions& options,
                   AlphaFit& fit) {
  const double moved_rad = fit.alpha_rad - options.initial_alpha_rad;
  const Eigen::VectorXd errors_rad = angles.error_rad.array() + moved_rad;
  const Eigen::VectorXd share = shares(errors_rad, angles.normal_variance, options);
  fit.sweeps_sigma_rad =
      scatter_of_sweeps(views, angles).widening() * std::sqrt(share.dot(angles.covariance * share));
  fit.walls_sigma_rad = walls_sigma_rad(errors_rad, share, angles.normal_variance);
  fit.sigma_rad = std::hypot(fit.sweeps_sigma_rad, fit.walls_sigma_rad);
}

std::string why_input_is_useless(const std::vector<AlphaSweep>& sweeps) {
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    if (!std::isfinite(sweeps[sweep].beta_rad) || !std::isfinite(sweeps[sweep].beta_sigma_rad)) {
      return in_words("sweep ", name_of(sweeps[sweep], sweep), " has no attitude: leave it out");
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
  WallAngles angles = fit_wall_angles(room, views, remarks);
  if (const auto why = why_sweeps_disagree(views, angles, options); !why.empty())
    return refused(why);
  const ChiSquare chi_of_sweeps = scatter_of_sweeps(views, angles);
  const ChiSquare chi_of_walls = scatter_of_walls(views, angles);
  angles = widen_normals(chi_of_walls.widening(), room, views);
  const AlphaOptions heard = with_loss_for(room.walls.size(), options);
  AlphaFit fit = fit_walls(angles, heard);
  fit.sweeps_used = views.size();
  fit.remarks = remarks;
  measure_errors(views, angles, room, options, fit);
  test_model(chi_of_sweeps, chi_of_walls, fit);
  measure_sigma(views, angles, heard, fit);
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
