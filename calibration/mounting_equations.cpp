#include "calibration/mounting_equations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

// A direction is seen when the data know it so much better than the rig file does.
constexpr double kLeastGain = 10.0;

using Directions = Eigen::Matrix<double, kMountingValues, Eigen::Dynamic>;

// The directions that the data show, over the prior's sigma and with unit information each; and
// the others.
struct Split {
  Directions seen;    // sigma * eigenvector / sqrt(eigenvalue)
  Directions unseen;  // sigma * eigenvector
};

// About their mean, which is none once the fit is at its end: before, all pull one way, and that is
// no scatter.
MountingMatrix scatter_of(const MountingEquations& equations) {
  const auto count = static_cast<double>(equations.groups.size());
  MountingMatrix scatter = MountingMatrix::Zero();
  for (const MountingVector& group : equations.groups) scatter += group * group.transpose();
  if (count > 0.0) scatter -= equations.gradient * equations.gradient.transpose() / count;
  return scatter;
}

// scatter: what the gradient varies by; where that is more than the information, what errs together
// makes the data worth less.
Split split_by_gain(const MountingMatrix& information, const MountingMatrix& scatter,
                    const MountingPrior& prior) {
  const auto scale = prior.sigma.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MountingMatrix> solver(scale * information * scale);
  Split split{Directions(kMountingValues, 0), Directions(kMountingValues, 0)};
  const auto append = [](Directions& to, const MountingVector& direction) {
    to.conservativeResize(Eigen::NoChange, to.cols() + 1);
    to.rightCols<1>() = direction;
  };
  for (int index = 0; index < kMountingValues; ++index) {
    const MountingVector direction = scale * solver.eigenvectors().col(index);
    const double worth = solver.eigenvalues()[index];
    const double widening = std::max(1.0, direction.dot(scatter * direction) / worth);
    const bool seen = worth > kLeastGain * kLeastGain * widening;
    append(seen ? split.seen : split.unseen, seen ? direction / std::sqrt(worth) : direction);
  }
  return split;
}

// How much larger the errors are than independent noise makes them, in directions of unit
// information: never less than 1.
Eigen::MatrixXd widened(const MountingMatrix& scatter, const Directions& seen) {
  if (seen.cols() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(seen.transpose() * scatter * seen);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(1.0).asDiagonal() *
         solver.eigenvectors().transpose();
}

MountingSolution solution_of(const Split& split, const Eigen::MatrixXd& widening,
                             const MountingVector& value) {
  MountingSolution solution;
  solution.value = value;
  solution.seen_directions = static_cast<int>(split.seen.cols());
  const MountingMatrix unseen = split.unseen * split.unseen.transpose();
  solution.covariance = unseen;
  if (solution.seen_directions > 0) {
    solution.covariance += split.seen * widening * split.seen.transpose();
    const Eigen::MatrixXd back = split.seen.completeOrthogonalDecomposition().pseudoInverse();
    solution.information = back.transpose() * widening.inverse() * back;
  }
  return solution;
}

MountingVector unseen_shares(const Split& split, const MountingPrior& prior) {
  MountingVector shares = split.unseen.rowwise().squaredNorm();
  for (int value = 0; value < kMountingValues; ++value) {
    const double variance = prior.sigma[value] * prior.sigma[value];
    shares[value] = variance > 0.0 ? shares[value] / variance : 1.0;
  }
  return shares;
}

}  // namespace

MountingPrior prior_of(const RigGeometry& nominal) {
  MountingPrior prior;
  prior.nominal = mounting_of(nominal);
  prior.sigma[kMountingBias] = rad_from_deg(5.0);
  prior.sigma[kMountingTilt] = rad_from_deg(2.0);
  prior.sigma[kMountingLeverX] = 0.03;
  prior.sigma[kMountingLeverY] = 0.03;
  prior.sigma[kAxisHysteresis] = rad_from_deg(1.0);
  prior.sigma[kRangeOffset] = 0.02;
  return prior;
}

void MountingEquations::add(const MountingEquations& more) {
  information += more.information;
  gradient += more.gradient;
  groups.insert(groups.end(), more.groups.begin(), more.groups.end());
}

MountingSolution solve(const MountingEquations& equations, const MountingVector& value,
                       const MountingPrior& prior) {
  const MountingMatrix scatter = scatter_of(equations);
  const Split split = split_by_gain(equations.information, scatter, prior);
  const MountingVector pull = equations.information * (value - prior.nominal) - equations.gradient;
  const MountingVector found = prior.nominal + split.seen * (split.seen.transpose() * pull);
  MountingSolution solution = solution_of(split, widened(scatter, split.seen), found);
  solution.unseen = unseen_shares(split, prior);
  return solution;
}

MountingSolution solve_together(const std::vector<MountingSolution>& sweeps,
                                const MountingPrior& prior) {
  MountingMatrix information = MountingMatrix::Zero();
  MountingVector pull = MountingVector::Zero();
  for (const MountingSolution& sweep : sweeps) {
    information += sweep.information;
    pull += sweep.information * (sweep.value - prior.nominal);
  }
  const Split split = split_by_gain(information, information, prior);
  const Eigen::Index seen = split.seen.cols();
  MountingSolution solution =
      solution_of(split, Eigen::MatrixXd::Identity(seen, seen),
                  prior.nominal + split.seen * (split.seen.transpose() * pull));
  solution.unseen = unseen_shares(split, prior);
  return solution;
}

}  // namespace swivel
