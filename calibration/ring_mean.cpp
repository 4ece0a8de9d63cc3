#include "calibration/ring_mean.hpp"

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "calibration/in_words.hpp"
#include "calibration/plate_view.hpp"

namespace swivel {
namespace {

constexpr double kBesideM = 0.006;  // from the outline: the spot is 4 mm wide
constexpr std::size_t kLeastPointsInRing = 50;

// The mean and the outline are two views of one plate; further apart than this and than four
// sigma, there is more or less in the ring than the plate.
constexpr double kAllowedDisagreementRad = rad_from_deg(1.5);

// Part of the angle between lines by which the mean of a plate cut into lines is off, rms.
constexpr double kLineSampling = 0.025;

// The ring's points, and what their mean and its uncertainty are made of.
struct RingPoints {
  std::vector<Eigen::Vector3d> points;
  std::size_t lines = 0;
};

RingPoints cut_ring(const OrganisedCloud& cloud, const PlateGeometry& plate, double height_m) {
  RingPoints ring;
  for (std::size_t line = 0; line < cloud.lines; ++line) {
    const std::size_t before = ring.points.size();
    for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
      const CloudPoint& point = cloud.line(line)[beam];
      if (in_ring(point, plate, height_m)) {
        ring.points.emplace_back(point.x_m, point.y_m, point.z_m);
      }
    }
    if (ring.points.size() > before) ++ring.lines;
  }
  return ring;
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

double rms_height_m(const RingPoints& ring, double height_m) {
  double squares = 0.0;
  for (const Eigen::Vector3d& point : ring.points) squares += std::pow(point.z() - height_m, 2);
  return std::sqrt(squares / static_cast<double>(ring.points.size()));
}

// Eq. (7): whether a beam on the plate measures in the ring is chance, with probability
// `occupancy`; each that does pulls the mean by its azimuth.
double sigma_rad(const RingPoints& ring, double beta_rad, const PlateView& view) {
  double squares = 0.0;
  for (const Eigen::Vector3d& point : ring.points) {
    squares += std::pow(std::remainder(std::atan2(point.y(), point.x()) - beta_rad, 2 * kPi), 2);
  }
  const auto count = static_cast<double>(ring.points.size());
  const double chance_rad = std::sqrt((1.0 - view.occupancy) * squares) / count;
  return std::hypot(chance_rad, kLineSampling * view.line_step_rad);
}

AttitudeEstimate refusal(AttitudeEstimate estimate, AttitudeVerdict verdict,
                         const std::string& reason) {
  estimate.verdict = verdict;
  estimate.reason = reason;
  return estimate;
}

}  // namespace

AttitudeEstimate estimate_by_ring_mean(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                       const RigGeometry& rig) {
  const double height_m = plate_height_m(plate, rig);
  const RingPoints ring = cut_ring(cloud, plate, height_m);
  AttitudeEstimate estimate;
  estimate.points_used = ring.points.size();
  estimate.edges_used = 2 * ring.lines;
  if (ring.points.size() < kLeastPointsInRing) {
    return refusal(estimate, AttitudeVerdict::kNoPlate,
                   in_words("no plate: only ", ring.points.size(), " points in the ring"));
  }
  estimate.residual_m = rms_height_m(ring, height_m);
  const Eigen::Vector3d centre = mean_of(ring.points);
  const double beta_rad = std::atan2(centre.y(), centre.x());
  const std::vector<PlateBeam> beams = beams_at_plate(cloud, plate, rig);
  const PlateView view = judge_plate(cloud, plate, beams, beta_rad);
  if (view.verdict != AttitudeVerdict::kGood) return refusal(estimate, view.verdict, view.reason);
  const std::string foreign = foreign_object(plate, beams, view.outline_beta_rad, kBesideM);
  if (!foreign.empty()) return refusal(estimate, AttitudeVerdict::kForeignObject, foreign);

  const double beta_sigma_rad = sigma_rad(ring, beta_rad, view);
  const double apart_rad = std::abs(beta_rad - view.outline_beta_rad);
  if (apart_rad > std::max(kAllowedDisagreementRad, 4.0 * beta_sigma_rad)) {
    return refusal(estimate, AttitudeVerdict::kForeignObject,
                   in_words("the ring's mean and the plate's outline are ", spoken_deg(apart_rad),
                            " deg apart: there is more or less in the ring than the plate"));
  }
  estimate.verdict = AttitudeVerdict::kGood;
  estimate.beta_rad = beta_rad;
  estimate.beta_sigma_rad = beta_sigma_rad;
  return estimate;
}

}  // namespace swivel
