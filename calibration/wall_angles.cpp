#include "calibration/wall_angles.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calibration/in_words.hpp"

namespace swivel {
namespace {

constexpr double kMisfitSigmas = 5.0;  // of one wall in one sweep: it was something else
constexpr double kLeastMisfitRad = rad_from_deg(0.05);
constexpr double kLeastSigmaRad = 1e-6;  // what claims less still has rounding

// What a sweep's walls are off together: its beta's error.
struct Common {
  double error_rad;
  double variance;
};

// Of the errors of one sweep's walls, which share its beta.
Eigen::MatrixXd covariance_of(const SweepView& view) {
  const auto count = static_cast<Eigen::Index>(view.sightings.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(count, count, view.beta_variance);
  for (Eigen::Index index = 0; index < count; ++index) {
    covariance(index, index) += view.sightings[static_cast<std::size_t>(index)].variance;
  }
  return covariance;
}

// Of a wall's mean angle, by its normals alone.
Eigen::VectorXd normal_variances(const Views& views, std::size_t walls) {
  Eigen::VectorXd information = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(walls));
  for (const SweepView& view : views) {
    for (const WallSighting& sighting : view.sightings) {
      information(static_cast<Eigen::Index>(sighting.wall)) += 1.0 / sighting.variance;
    }
  }
  return information.cwiseInverse();
}

// Eq. (9).
WallAngles fit_angles(const Views& views, std::size_t walls) {
  const auto count = static_cast<Eigen::Index>(walls);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(count);
  for (const SweepView& view : views) {
    const Eigen::MatrixXd weights = covariance_of(view).inverse();
    for (Eigen::Index row = 0; row < weights.rows(); ++row) {
      const auto wall =
          static_cast<Eigen::Index>(view.sightings[static_cast<std::size_t>(row)].wall);
      for (Eigen::Index column = 0; column < weights.cols(); ++column) {
        const WallSighting& other = view.sightings[static_cast<std::size_t>(column)];
        information(wall, static_cast<Eigen::Index>(other.wall)) += weights(row, column);
        pull(wall) += weights(row, column) * other.error_rad;
      }
    }
  }
  const Eigen::MatrixXd covariance = information.inverse();
  return {covariance * pull, covariance, normal_variances(views, walls)};
}

double off_rad(const WallSighting& sighting, const WallAngles& angles) {
  return sighting.error_rad - angles.error_rad(static_cast<Eigen::Index>(sighting.wall));
}

Common common_of(const SweepView& view, const WallAngles& angles) {
  double weights = 0.0;
  double sum = 0.0;
  for (const WallSighting& sighting : view.sightings) {
    weights += 1.0 / sighting.variance;
    sum += off_rad(sighting, angles) / sighting.variance;
  }
  return {sum / weights, view.beta_variance + 1.0 / weights};
}

std::size_t sightings_of_wall(const Views& views, std::size_t wall) {
  std::size_t count = 0;
  for (const SweepView& view : views) {
    for (const WallSighting& sighting : view.sightings) count += sighting.wall == wall ? 1 : 0;
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
      const WallSighting& sighting = view.sightings[index];
      const double misfit_rad = std::abs(off_rad(sighting, angles) - common_rad);
      const double sigmas = misfit_rad / std::sqrt(sighting.variance);
      if (misfit_rad < kLeastMisfitRad || sigmas < worst_sigmas) continue;
      if (view.sightings.size() < 2 || sightings_of_wall(views, sighting.wall) < 3) continue;
      worst_sigmas = sigmas;
      worst_view = &view;
      worst = index;
    }
  }
  if (worst_view == nullptr) return false;
  const std::size_t side = room.walls[worst_view->sightings[worst].wall].side;
  remarks.push_back(in_words("left out, unlike what the other sweeps saw: the ", kWallNames[side],
                             " wall in sweep ", worst_view->name));
  worst_view->sightings.erase(worst_view->sightings.begin() + static_cast<std::ptrdiff_t>(worst));
  return true;
}

}  // namespace

std::string name_of(const AlphaSweep& sweep, std::size_t index) {
  return sweep.name.empty() ? std::to_string(index + 1) : sweep.name;
}

Views views_of(const std::vector<AlphaSweep>& sweeps, const RoomWalls& room,
               const AlphaOptions& options) {
  Views views;
  for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
    const AlphaSweep& seen = sweeps[sweep];
    const double beta_sigma_rad = std::max(seen.beta_sigma_rad, kLeastSigmaRad);
    SweepView view{name_of(seen, sweep), beta_sigma_rad * beta_sigma_rad, {}};
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

std::string leave_out_blind(Views& views) {
  std::string names;
  for (const SweepView& view : views) {
    if (view.sightings.empty()) names += (names.empty() ? "" : ", ") + view.name;
  }
  const auto blind = [](const SweepView& view) { return view.sightings.empty(); };
  views.erase(std::remove_if(views.begin(), views.end(), blind), views.end());
  return names.empty() ? "" : "left out, none of the room's walls seen: sweep " + names;
}

WallAngles fit_wall_angles(const RoomWalls& room, Views& views, std::vector<std::string>& remarks) {
  WallAngles angles = fit_angles(views, room.walls.size());
  while (take_out_worst(views, angles, room, remarks)) {
    angles = fit_angles(views, room.walls.size());
  }
  return angles;
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
    reason = in_words("the sweeps disagree: sweep ", view.name, " is ", spoken_deg(error_rad),
                      " deg off the median, ", sigmas,
                      " times its sigma; see that rig and room stand still, then repeat");
  }
  return reason;
}

ChiSquare scatter_of_sweeps(const Views& views, const WallAngles& angles) {
  ChiSquare chi{0.0, static_cast<double>(views.size()) - 1.0};
  for (const SweepView& view : views) {
    const Common common = common_of(view, angles);
    chi.sum += common.error_rad * common.error_rad / common.variance;
  }
  return chi;
}

ChiSquare scatter_of_walls(const Views& views, const WallAngles& angles) {
  ChiSquare chi{0.0, 1.0 - static_cast<double>(angles.error_rad.size())};
  for (const SweepView& view : views) {
    const double common_rad = common_of(view, angles).error_rad;
    chi.freedom += static_cast<double>(view.sightings.size()) - 1.0;
    for (const WallSighting& sighting : view.sightings) {
      const double error_rad = off_rad(sighting, angles) - common_rad;
      chi.sum += error_rad * error_rad / sighting.variance;
    }
  }
  return chi;
}

WallAngles widen_normals(double times, const RoomWalls& room, Views& views) {
  for (SweepView& view : views) {
    for (WallSighting& sighting : view.sightings) sighting.variance *= times * times;
  }
  return fit_angles(views, room.walls.size());
}

}  // namespace swivel
