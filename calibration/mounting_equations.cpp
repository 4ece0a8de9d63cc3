#include "calibration/mounting_equations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

// A direction is seen when the data know it so much better than the rig file does.
constexpr double kLeastGain = 10.0;

// The directions that the data show, over the prior's sigma and with unit information each; and
// the others. A column each, the rest are zero.
struct Split {
  MountingMatrix seen = MountingMatrix::Zero();     // sigma * eigenvector / sqrt(eigenvalue)
  MountingMatrix told_by = MountingMatrix::Zero();  // sqrt(eigenvalue) * eigenvector / sigma
  MountingMatrix unseen = MountingMatrix::Zero();   // sigma * eigenvector
  int seen_directions = 0;
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
  const MountingVector inverse_sigma =
      (prior.sigma.array() > 0.0).select(prior.sigma.cwiseInverse(), 0.0);
  Split split;
  for (int index = 0; index < kMountingValues; ++index) {
    const MountingVector eigenvector = solver.eigenvectors().col(index);
    const MountingVector direction = scale * eigenvector;
    const double worth = solver.eigenvalues()[index];
    const double widening = std::max(1.0, direction.dot(scatter * direction) / worth);
    if (worth > kLeastGain * kLeastGain * widening) {
      split.seen.col(index) = direction / std::sqrt(worth);
      split.told_by.col(index) = std::sqrt(worth) * inverse_sigma.cwiseProduct(eigenvector);
      ++split.seen_directions;
    } else {
      split.unseen.col(index) = direction;
    }
  }
  return split;
}

// The errors are larger than independent noise makes them by the scatter's eigenvalues, in
// directions of unit information; never smaller.
MountingSolution solution_of(const Split& split, const MountingMatrix& scatter,
                             const MountingVector& value) {
  const Eigen::SelfAdjointEigenSolver<MountingMatrix> solver(split.seen.transpose() * scatter *
                                                             split.seen);
  const MountingVector widening = solver.eigenvalues().cwiseMax(1.0);
  const MountingMatrix seen = split.seen * solver.eigenvectors();
  const MountingMatrix told_by = split.told_by * solver.eigenvectors();
  MountingSolution solution;
  solution.value = value;
  solution.seen_directions = split.seen_directions;
  solution.covariance = split.unseen * split.unseen.transpose();
  solution.covariance += seen * widening.asDiagonal() * seen.transpose();
  solution.information = told_by * widening.cwiseInverse().asDiagonal() * told_by.transpose();
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
  MountingSolution solution = solution_of(split, scatter, found);
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
  const MountingVector value = prior.nominal + split.seen * (split.seen.transpose() * pull);
  MountingSolution solution = solution_of(split, MountingMatrix::Zero(), value);
  solution.unseen = unseen_shares(split, prior);
  return solution;
}

}  // namespace swivel
