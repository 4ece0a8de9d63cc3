#include "calibration/plate_outline.hpp"

#include <cmath>

#include "calibration/in_words.hpp"
#include "calibration/plate_fit.hpp"
#include "calibration/plate_view.hpp"

namespace swivel {
namespace {

constexpr std::size_t kLeastBeamsInRing = 50;
constexpr std::size_t kLeastEdgeBeams = 40;
constexpr double kWidestSigma_rad = rad_from_deg(1.0);
constexpr double kAllowedCorrection_rad = rad_from_deg(4.0);  // of the first, coarse outline
constexpr double kWorstMisfit = 5.0;  // with a plate 0.05 to 1.6; 100 where every edge is elsewhere

constexpr double kBeside_m = 0.005;  // the edges are soft

// Where the beams that measured in the ring are, on the mean.
struct InRing {
  std::size_t beams = 0;
  double azimuth_rad = 0.0;
};

InRing mean_in_ring(const std::vector<PlateBeam>& beams) {
  InRing ring;
  double x_m = 0.0;
  double y_m = 0.0;
  for (const PlateBeam& beam : beams) {
    if (!beam.in_ring) continue;
    ++ring.beams;
    x_m += beam.x_m;
    y_m += beam.y_m;
  }
  ring.azimuth_rad = std::atan2(y_m, x_m);
  return ring;
}

AttitudeEstimate refusal(AttitudeVerdict verdict, const std::string& reason) {
  AttitudeEstimate estimate;
  estimate.verdict = verdict;
  estimate.reason = reason;
  return estimate;
}

// What speaks against a fit; empty if nothing does.
std::string doubts(const PlateFit& fit, const PlateView& view, const PlateGeometry& plate,
                   const std::vector<PlateBeam>& beams) {
  const double correction_rad = std::abs(fit.beta_rad - view.outline_beta_rad);
  if (correction_rad > kAllowedCorrection_rad)
    return in_words("the outline's edges and its area are ", spoken_deg(correction_rad),
                    " deg apart: there is more or less in the ring than the plate");
  if (fit.misfit > kWorstMisfit)
    return in_words("the edges seen are not those of the drawn plate (misfit ", fit.misfit,
                    ", at most ", kWorstMisfit, "): check the plate's measures in the rig file");
  return foreign_object(plate, beams, fit.beta_rad, kBeside_m + fit.shape.growth_m.value);
}

}  // namespace

AttitudeEstimate estimate_by_plate_outline(const OrganisedCloud& cloud, const PlateGeometry& plate,
                                           const RigGeometry& rig) {
  const std::vector<PlateBeam> beams = beams_at_plate(cloud, plate, rig);
  const InRing ring = mean_in_ring(beams);
  if (ring.beams < kLeastBeamsInRing)
    return refusal(AttitudeVerdict::kNoPlate,
                   in_words("no plate: only ", ring.beams, " points in the ring"));
  const PlateView view = judge_plate(cloud, plate, beams, ring.azimuth_rad);
  if (view.verdict != AttitudeVerdict::kGood) return refusal(view.verdict, view.reason);
  const std::optional<PlateFit> fit = fit_plate(beams, plate, view.outline_beta_rad);
  if (!fit)
    return refusal(AttitudeVerdict::kForeignObject,
                   "no plate of the drawn measures fits what is in the ring");
  if (fit->edge_beams < kLeastEdgeBeams || fit->beta_sigma_rad > kWidestSigma_rad)
    return refusal(AttitudeVerdict::kTooFewPoints,
                   in_words("too few beams at the plate's edges: ", fit->edge_beams,
                            ", which leaves ", spoken_deg(fit->beta_sigma_rad), " deg of doubt"));
  if (const std::string words = doubts(*fit, view, plate, beams); !words.empty())
    return refusal(AttitudeVerdict::kForeignObject, words);

  AttitudeEstimate estimate;
  estimate.verdict = AttitudeVerdict::kGood;
  estimate.beta_rad = fit->beta_rad;
  estimate.beta_sigma_rad = fit->beta_sigma_rad;
  estimate.points_used = fit->hits;
  estimate.edges_used = fit->edge_beams;
  estimate.residual_m = fit->residual_m;
  estimate.fit = fit;
  return estimate;
}

}  // namespace swivel
