#include "calibration/plate_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "calibration/in_words.hpp"

namespace swivel {
namespace {

// Beams nearer to the outline than this say neither inside nor outside: the spot is 4 mm, the
// lines of the fastest mode lie 6 mm apart.
constexpr double kInsideMarginM = 0.004;

// The outline is searched for about a first guess, then about the best place found.
struct Search {
  double reach_rad;
  double step_rad;
  std::size_t most_beams;
};
constexpr Search kCoarse{rad_from_deg(30.0), rad_from_deg(3.0), 3'000};
constexpr Search kFine{rad_from_deg(3.0), rad_from_deg(0.5), 5'000};
constexpr double kFitShare = 0.3;  // of beams in the ring, between plate and no plate
constexpr double kFitDepthM = 0.010;
constexpr double kSectorHalfWidthRad = rad_from_deg(44.0);  // the corners lie at 45.6 deg

// Of the beams on the plate, how many must have measured in the ring. At a range noise of
// 13 mm it is 0.65, at 30 mm 0.25; a surface 40 mm below the plate gives 0.05.
constexpr double kAnyPlate = 0.08;
constexpr double kEnoughPlate = 0.15;
constexpr std::size_t kLeastBeams = 100;
constexpr double kForeignShare = 0.25;  // of a cell outside of the plate
constexpr double kHiddenShare = 0.4;    // of a cell on the plate, against the others
constexpr double kTellingCount = 8.0;   // expected in a cell, for none to mean something

// A count of beams and of those that measured in the ring.
struct Tally {
  std::size_t beams = 0;
  std::size_t hits = 0;

  void add(bool hit) {
    ++beams;
    if (hit) ++hits;
  }
  double share() const {
    return beams == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(beams);
  }
};

// Of beams, more only take time.
constexpr std::size_t kTalliedBeams = 15'000;  // in cells
constexpr std::size_t kSlopeBeams = 5'000;     // of azimuth by line

// Every so many of them are no more than `most`.
std::size_t stride_to(std::size_t most, const std::vector<PlateBeam>& beams) {
  return 1 + beams.size() / most;
}

// Cells of 10 deg and 18 mm about the axis, counted from the plate's middle line.
class CellGrid {
 public:
  CellGrid(const PlateGeometry& plate, double beta_rad) : plate_(plate), beta_rad_(beta_rad) {}

  Tally& cell_of(const PlateBeam& beam) {
    const double azimuth_rad = beam.azimuth_rad - beta_rad_;  // both on the side of X' > 0
    const double radius_m = std::sqrt(beam.x_m * beam.x_m + beam.y_m * beam.y_m);
    const double part =
        (radius_m - plate_.ring_inner_m) / (plate_.ring_outer_m - plate_.ring_inner_m);
    const auto ring = static_cast<std::size_t>(std::clamp(part * kRings, 0.0, kRings - 1.0));
    const double turn = (azimuth_rad + kPi) / (2 * kPi);
    const auto sector = static_cast<std::size_t>(std::clamp(turn * kSectors, 0.0, kSectors - 1.0));
    return cells_[ring * kSectors + sector];
  }

  static double azimuth_deg(std::size_t cell) {
    return (static_cast<double>(cell % kSectors) + 0.5) * 360.0 / kSectors - 180.0;
  }

  static constexpr std::size_t kSectors = 36;
  static constexpr std::size_t kRings = 3;
  using Cells = std::array<Tally, kSectors * kRings>;
  const Cells& cells() const { return cells_; }

 private:
  PlateGeometry plate_;
  double beta_rad_;
  Cells cells_{};
};

Tally on_plate(const PlateGeometry& plate, const std::vector<PlateBeam>& beams, double beta_rad) {
  const PlateOutline outline(plate, beta_rad);
  Tally tally;
  for (const PlateBeam& beam : beams) {
    if (outline.inside_m(beam.x_m, beam.y_m) > kInsideMarginM) {
      tally.add(beam.in_ring);
    }
  }
  return tally;
}

// How well the outline fits there: hits should lie inside and misses outside, and the more so
// the further from it, up to kFitDepthM.
double outline_score(const PlateGeometry& plate, const std::vector<PlateBeam>& beams,
                     double beta_rad, std::size_t stride) {
  const PlateOutline outline(plate, beta_rad);
  double score = 0.0;
  for (std::size_t index = 0; index < beams.size(); index += stride) {
    const PlateBeam& beam = beams[index];
    const double inside_m = outline.inside_m(beam.x_m, beam.y_m);
    const double weight = beam.in_ring ? 1.0 - kFitShare : -kFitShare;
    score += weight * std::clamp(inside_m, -kFitDepthM, kFitDepthM);
  }
  return score;
}

double fit_outline(const PlateGeometry& plate, const std::vector<PlateBeam>& beams, double beta_rad,
                   const Search& search) {
  const std::size_t stride = stride_to(search.most_beams, beams);
  double best_rad = beta_rad;
  double best_score = outline_score(plate, beams, beta_rad, stride);
  const auto steps = static_cast<int>(std::lround(search.reach_rad / search.step_rad));
  for (int step = -steps; step <= steps; ++step) {
    const double shifted_rad = beta_rad + step * search.step_rad;
    const double score = outline_score(plate, beams, shifted_rad, stride);
    if (score > best_score) {
      best_score = score;
      best_rad = shifted_rad;
    }
  }
  return best_rad;
}

// Where the beams of a line meet the plate's plane on the mean: azimuth = first + step * line.
struct LineAzimuths {
  double first_rad = 0.0;
  double step_rad = 0.0;
  std::vector<std::size_t> beams;  // a line
};

// Beams further off than this are of the fan's other end, half a turn away.
constexpr double kOtherEndRad = 0.7;

LineAzimuths fit_near(const std::vector<PlateBeam>& beams, std::size_t stride,
                      const LineAzimuths& guess, double within_rad) {
  LineAzimuths fit;
  fit.beams.assign(guess.beams.size(), 0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();  // of line and azimuth
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (std::size_t index = 0; index < beams.size(); index += stride) {
    const PlateBeam& beam = beams[index];
    const auto line = static_cast<double>(beam.line);
    const double guessed_rad = guess.first_rad + guess.step_rad * line;
    if (std::abs(beam.azimuth_rad - guessed_rad) > within_rad) continue;
    ++fit.beams[beam.line];
    count += 1.0;
    sum += Eigen::Vector2d(line, beam.azimuth_rad);
    products += line * Eigen::Vector2d(line, beam.azimuth_rad);
  }
  if (count < 1.0) return fit;
  const double squares = products.x() - sum.x() * sum.x() / count;
  fit.step_rad = squares > 0.0 ? (products.y() - sum.x() * sum.y() / count) / squares : 0.0;
  fit.first_rad = (sum.y() - fit.step_rad * sum.x()) / count;
  return fit;
}

LineAzimuths fit_line_azimuths(const std::vector<PlateBeam>& beams, std::size_t lines) {
  const std::size_t stride = stride_to(kSlopeBeams, beams);
  LineAzimuths fit;
  fit.beams.assign(lines, 0);
  for (const double within_rad : {2 * kPi, 2 * kOtherEndRad, kOtherEndRad}) {
    fit = fit_near(beams, stride, fit, within_rad);
  }
  return fit_near(beams, 1, fit, kOtherEndRad);
}

std::size_t usual_beams(const LineAzimuths& azimuths) {
  std::vector<std::size_t> seen;
  std::copy_if(azimuths.beams.begin(), azimuths.beams.end(), std::back_inserter(seen),
               [](std::size_t beams) { return beams > 0; });
  if (seen.empty()) return 0;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return *middle;
}

// Lines that should have crossed the plate and said little or nothing there.
std::string missing_lines(const LineAzimuths& azimuths, double beta_rad) {
  if (!(std::abs(azimuths.step_rad) > 0.0)) return "all lines of the sweep lie on one another";
  const double one = (beta_rad - kSectorHalfWidthRad - azimuths.first_rad) / azimuths.step_rad;
  const double other = (beta_rad + kSectorHalfWidthRad - azimuths.first_rad) / azimuths.step_rad;
  const double first = std::ceil(std::min(one, other));
  const double last = std::floor(std::max(one, other));
  if (first < 0.0 || last > static_cast<double>(azimuths.beams.size()) - 1.0) {
    return "the sweep begins or ends on the plate: it must see the plate whole";
  }
  const std::size_t usual = usual_beams(azimuths);
  std::size_t missing = 0;
  for (auto line = static_cast<std::size_t>(first); line <= static_cast<std::size_t>(last);
       ++line) {
    if (4 * azimuths.beams[line] < usual) ++missing;
  }
  if (missing == 0) return {};
  return in_words(missing, " of the ", last - first + 1.0,
                  " lines that cross the plate are missing or empty there");
}

// Cells on the plate in which far less was seen than in the others.
std::string hidden_part(const PlateGeometry& plate, const std::vector<PlateBeam>& beams,
                        double beta_rad) {
  const PlateOutline outline(plate, beta_rad);
  CellGrid grid(plate, beta_rad);
  for (std::size_t index = 0; index < beams.size(); index += stride_to(kTalliedBeams, beams)) {
    const PlateBeam& beam = beams[index];
    if (outline.inside_m(beam.x_m, beam.y_m) > kInsideMarginM) {
      grid.cell_of(beam).add(beam.in_ring);
    }
  }
  std::vector<double> shares;
  for (const Tally& cell : grid.cells()) {
    if (cell.beams >= 10) shares.push_back(cell.share());
  }
  std::sort(shares.begin(), shares.end());
  const double usual = shares.empty() ? 0.0 : shares[shares.size() * 2 / 3];
  for (std::size_t index = 0; index < grid.cells().size(); ++index) {
    const Tally& cell = grid.cells()[index];
    const double expected = usual * static_cast<double>(cell.beams);
    const double least = std::max(kHiddenShare * expected - 2.0 * std::sqrt(expected), 0.5);
    if (expected < kTellingCount || static_cast<double>(cell.hits) >= least) continue;
    return in_words("a part of the plate is hidden: at ", CellGrid::azimuth_deg(index),
                    " deg from its middle ", cell.hits, " of ", cell.beams, " beams met it, where ",
                    std::round(expected), " would; clear what stands over the plate");
  }
  return {};
}

}  // namespace

PlateOutline::PlateOutline(const PlateGeometry& plate, double beta_rad)
    : plate_(plate), cos_beta_(std::cos(beta_rad)), sin_beta_(std::sin(beta_rad)) {}

double PlateOutline::inside_m(double x_m, double y_m) const {
  const double along_m = cos_beta_ * x_m + sin_beta_ * y_m;
  const double across_m = -sin_beta_ * x_m + cos_beta_ * y_m;
  const double beyond_base_m = along_m - plate_.base_distance_m;
  const double short_of_legs_m =
      (plate_.hypotenuse_m / 2 - beyond_base_m - std::abs(across_m)) * std::sqrt(0.5);
  return std::min(beyond_base_m, short_of_legs_m);
}

PlateView judge_plate(const OrganisedCloud& cloud, const PlateGeometry& plate,
                      const std::vector<PlateBeam>& beams, double beta_rad) {
  PlateView view;
  const double near_rad = fit_outline(plate, beams, beta_rad, kCoarse);
  view.outline_beta_rad = fit_outline(plate, beams, near_rad, kFine);
  const Tally tally = on_plate(plate, beams, view.outline_beta_rad);
  view.occupancy = tally.share();
  const auto say = [&view](AttitudeVerdict verdict, const std::string& reason) {
    view.verdict = verdict;
    view.reason = reason;
    return view;
  };
  const std::string seen =
      in_words(tally.hits, " of the ", tally.beams, " beams that would meet the plate did");
  if (tally.beams >= kLeastBeams && view.occupancy < kAnyPlate) {
    return say(AttitudeVerdict::kNoPlate, "no plate: " + seen);
  }
  const LineAzimuths azimuths = fit_line_azimuths(beams, cloud.lines);
  view.line_step_rad = azimuths.step_rad;
  const std::string missing = missing_lines(azimuths, view.outline_beta_rad);
  if (!missing.empty()) return say(AttitudeVerdict::kLinesMissing, missing);
  if (tally.beams < kLeastBeams || view.occupancy < kEnoughPlate) {
    return say(AttitudeVerdict::kTooFewPoints, "too few points on the plate: " + seen);
  }
  const std::string hidden = hidden_part(plate, beams, view.outline_beta_rad);
  if (!hidden.empty()) return say(AttitudeVerdict::kForeignObject, hidden);
  return say(AttitudeVerdict::kGood, "");
}

std::string foreign_object(const PlateGeometry& plate, const std::vector<PlateBeam>& beams,
                           double beta_rad, double margin_m) {
  const PlateOutline outline(plate, beta_rad);
  CellGrid grid(plate, beta_rad);
  for (std::size_t index = 0; index < beams.size(); index += stride_to(kTalliedBeams, beams)) {
    const PlateBeam& beam = beams[index];
    if (outline.inside_m(beam.x_m, beam.y_m) < -margin_m) {
      grid.cell_of(beam).add(beam.in_ring);
    }
  }
  for (std::size_t index = 0; index < grid.cells().size(); ++index) {
    const Tally& cell = grid.cells()[index];
    const double limit = 3.0 + kForeignShare * static_cast<double>(cell.beams);
    if (static_cast<double>(cell.hits) <= limit) continue;
    return in_words("something else is in the ring: ", cell.hits, " of ", cell.beams,
                    " beams met it at ", CellGrid::azimuth_deg(index),
                    " deg from the plate's middle; clear cables and the like away");
  }
  return {};
}

}  // namespace swivel
