#include "calibration/half_scans.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace swivel {
namespace {

constexpr std::size_t kFewestRaysOfAView = 8;
constexpr double kFurthestM = 12.0;       // beyond, rays are too far apart to fill a cell
constexpr double kThickestOfCell = 0.15;  // rms over the cell's size
constexpr double kNarrowestOfCell = 0.08;
constexpr double kFloorM = 0.0005;  // no mean of a cell is known better
constexpr double kRobustSigmas = 2.0;
constexpr double kLeastIncidence = 0.3;
constexpr std::size_t kRaysCompared = 100'000;  // are enough to come near
constexpr std::size_t kFewestCells = 12;
// Of a cell, over the median range: from coarse to fine.
constexpr std::array<double, 9> kCellShares = {0.35, 0.35, 0.35, 0.26, 0.26,
                                               0.17, 0.17, 0.13, 0.13};

using CellKey = std::int64_t;

CellKey cell_at(const Eigen::Vector3d& point, double cell_m) {
  constexpr std::int64_t kMany = 1 << 20;
  const auto step = [cell_m](double coordinate_m) -> std::int64_t {
    const double steps = std::floor(coordinate_m / cell_m);
    // What is nowhere, or too far for any room, lies at the rim: a fit that runs away may say so.
    if (!(std::abs(steps) < kMany / 2.0)) return 0;
    return static_cast<std::int64_t>(steps) + kMany / 2;
  };
  return (step(point.x()) * kMany + step(point.y())) * kMany + step(point.z());
}

struct ViewOfCell {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  MountingVector moves = MountingVector::Zero();  // sum, along the cell's normal

  Eigen::Vector3d mean() const { return sum / count; }
  double variance_along(const Eigen::Vector3d& normal) const {
    const double mean_m = normal.dot(mean());
    return std::max(0.0, normal.dot(squares * normal) / count - mean_m * mean_m);
  }
};

struct Cell {
  std::array<ViewOfCell, 2> views;
  std::optional<Eigen::Vector3d> normal;  // none: it is not flat, or one view does not see it
};

using Cells = std::unordered_map<CellKey, Cell>;

// Calls visit(line, beam, shaft, point at rest) of every ray that may speak.
template <typename Visit>
void for_each_ray(const SweepReadings& readings, const std::vector<View>& views,
                  const RayMask& left_out, const MountedBeams& beams, const Visit& visit) {
  const std::size_t count = readings.beams();
  for (std::size_t line = 0; line < readings.lines.size(); ++line) {
    if (views[line] == View::kOnlyOne) continue;
    const LineOfReadings& said = readings.lines[line];
    for (std::size_t beam = 0; beam < count; ++beam) {
      const auto range_m = static_cast<double>(said.ranges_m[beam]);
      if (!(range_m < kFurthestM)) continue;
      if (!left_out.empty() && left_out[line * count + beam] != 0) continue;
      const ShaftTurn shaft = beams.shaft_at(said, beam);
      visit(line, beam, shaft, shaft.to_rest(beams.turning_point(beam, range_m)));
    }
  }
}

// The direction of least scatter of both views together.
std::optional<Eigen::Vector3d> normal_of(const Cell& cell, double cell_m) {
  const ViewOfCell& one = cell.views[0];
  const ViewOfCell& other = cell.views[1];
  const auto fewest = static_cast<double>(kFewestRaysOfAView);
  if (one.count < fewest || other.count < fewest) return std::nullopt;
  const double count = one.count + other.count;
  const Eigen::Vector3d mean = (one.sum + other.sum) / count;
  const Eigen::Matrix3d scatter = (one.squares + other.squares) / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const double thickness_m = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  const double width_m = std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
  if (thickness_m > kThickestOfCell * cell_m || width_m < kNarrowestOfCell * cell_m)
    return std::nullopt;
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (std::abs(normal.dot(mean.normalized())) < kLeastIncidence) return std::nullopt;
  return normal;
}

Cells cells_of(const SweepReadings& readings, const std::vector<View>& views,
               const RayMask& left_out, const MountedBeams& beams, double cell_m) {
  Cells cells;
  const auto place = [&views](std::size_t line) { return views[line] == View::kFirst ? 0U : 1U; };
  for_each_ray(readings, views, left_out, beams,
               [&](std::size_t line, std::size_t, const ShaftTurn&, const Eigen::Vector3d& point) {
                 ViewOfCell& view = cells[cell_at(point, cell_m)].views[place(line)];
                 view.count += 1.0;
                 view.sum += point;
                 view.squares += point * point.transpose();
               });
  for (auto& [key, cell] : cells) cell.normal = normal_of(cell, cell_m);
  for_each_ray(readings, views, left_out, beams,
               [&](std::size_t line, std::size_t beam, const ShaftTurn& shaft,
                   const Eigen::Vector3d& point) {
                 Cell& cell = cells.at(cell_at(point, cell_m));
                 if (!cell.normal) return;
                 cell.views[place(line)].moves +=
                     beams.moves_along(shaft.to_turning(*cell.normal), readings.lines[line], beam,
                                       static_cast<double>(readings.lines[line].ranges_m[beam]));
               });
  return cells;
}

struct CellResidual {
  double apart_m;
  double sigma_m;
  MountingVector by_mounting;
};

std::vector<CellResidual> residuals_of(const Cells& cells) {
  std::vector<CellResidual> residuals;
  for (const auto& [key, cell] : cells) {
    if (!cell.normal) continue;
    const auto& [one, other] = cell.views;
    const double variance = one.variance_along(*cell.normal) / one.count +
                            other.variance_along(*cell.normal) / other.count;
    residuals.push_back({cell.normal->dot(one.mean() - other.mean()),
                         std::sqrt(variance + kFloorM * kFloorM),
                         one.moves / one.count - other.moves / other.count});
  }
  return residuals;
}

double scatter_in_sigmas(const std::vector<CellResidual>& residuals) {
  std::vector<double> sizes;
  sizes.reserve(residuals.size());
  for (const CellResidual& residual : residuals)
    sizes.push_back(std::abs(residual.apart_m) / residual.sigma_m);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(1.0, 1.4826 * *middle);
}

// Without what is seen once, and without most rays where there are many.
SweepReadings thinned(const SweepReadings& readings, const std::vector<View>& views) {
  SweepReadings thin = readings;
  thin.lines.clear();
  for (std::size_t line = 0; line < readings.lines.size(); ++line) {
    if (views[line] != View::kOnlyOne) thin.lines.push_back(readings.lines[line]);
  }
  const std::size_t rays = thin.lines.size() * thin.beams();
  const std::size_t stride = std::max<std::size_t>(1, rays / kRaysCompared);
  for (LineOfReadings& line : thin.lines) {
    for (std::size_t beam = 0; beam < line.ranges_m.size(); ++beam) {
      if (beam % stride != 0) line.ranges_m[beam] = std::nanf("");
    }
  }
  return thin;
}

}  // namespace

HalfScanCells compare_half_scans(const SweepReadings& readings, const std::vector<View>& views,
                                 const RayMask& left_out, const MountedBeams& beams,
                                 double cell_m) {
  const auto residuals = residuals_of(cells_of(readings, views, left_out, beams, cell_m));
  HalfScanCells compared;
  if (residuals.empty()) return compared;
  const double scatter = scatter_in_sigmas(residuals);
  double squares = 0.0;
  for (const CellResidual& residual : residuals) {
    const double sigma_m = scatter * residual.sigma_m;
    const double off = residual.apart_m / sigma_m;
    // Geman and McClure's: what moved, or is no plane, is let go.
    const double weight = std::pow(1.0 + std::pow(off / kRobustSigmas, 2), -2);
    const MountingVector row = residual.by_mounting / sigma_m;
    compared.equations.information += weight * row * row.transpose();
    compared.equations.gradient += weight * off * row;
    compared.equations.groups.emplace_back(weight * off * row);
    squares += residual.apart_m * residual.apart_m;
  }
  compared.cells = residuals.size();
  compared.residual_m = std::sqrt(squares / static_cast<double>(residuals.size()));
  return compared;
}

double finest_cell_m(const SweepReadings& readings, const std::vector<View>& views) {
  return kCellShares.back() * median_range_m(thinned(readings, views));
}

std::optional<ViewsApart> compare_apart(const SweepReadings& readings, const RigGeometry& nominal,
                                        const MountingVector& mounting) {
  const auto views = views_of_lines(readings);
  if (!views) return std::nullopt;
  const double cell_m = finest_cell_m(readings, *views);
  const auto apart_m = [&](const MountingVector& under) {
    return compare_half_scans(readings, *views, {}, {nominal, under, readings}, cell_m).residual_m;
  };
  return ViewsApart{apart_m(mounting_of(nominal)), apart_m(mounting)};
}

std::optional<HalfScansFit> fit_half_scans(const SweepReadings& readings,
                                           const RigGeometry& nominal, const MountingPrior& prior,
                                           const MountingVector& start) {
  const auto all_views = views_of_lines(readings);
  if (!all_views) return std::nullopt;
  const SweepReadings thin = thinned(readings, *all_views);
  const auto views = views_of_lines(thin);
  if (!views) return std::nullopt;
  HalfScansFit fit;
  fit.solution.value = start;
  const double scale_m = median_range_m(thin);
  for (const double share : kCellShares) {
    const MountedBeams beams(nominal, fit.solution.value, thin);
    const HalfScanCells compared = compare_half_scans(thin, *views, {}, beams, share * scale_m);
    if (compared.cells < kFewestCells) return std::nullopt;
    fit.cells = compared.cells;
    fit.residual_m = compared.residual_m;
    fit.solution = solve(compared.equations, fit.solution.value, prior);
  }
  return fit;
}

}  // namespace swivel
