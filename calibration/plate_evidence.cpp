#include "calibration/plate_evidence.hpp"

namespace swivel {
namespace {

constexpr double kCornerZone_m = 0.006;  // two edges nearer than this make a corner
constexpr double kSure_m = 0.007;        // beams further from the outline are sure of their side
constexpr double kOutlier_m = 0.08;      // off the plate: not measured on it
constexpr double kClip = 12.0;           // of a log-likelihood ratio
constexpr double kNear_m = 0.15;         // behind the plate: answers along with it
constexpr double kZone_softnesses = 4.0;
constexpr double kWidestZone_m = 0.014;

// How much likelier a measured range is of the plate than of anything else: two histograms, of
// beams surely on it and surely beside it.
class Evidence {
 public:
  void learn(double beyond_m, bool inside) { (inside ? on_ : beside_)[bin(beyond_m)] += 1.0; }

  void finish() {
    smooth(on_);
    smooth(beside_);
    for (std::size_t i = 0; i < kBins; ++i)
      ratios_[i] = std::clamp(std::log(on_[i] / beside_[i]), -kClip, kClip);
  }

  double ratio(double beyond_m) const { return ratios_[bin(beyond_m)]; }

 private:
  static constexpr std::size_t kBins = 42;  // 40 of 5 mm, and all that is further to either side
  static constexpr double kBin_m = 0.005;
  using Histogram = std::array<double, kBins>;

  static std::size_t bin(double beyond_m) {
    const double place = beyond_m / kBin_m + 0.5 * kBins;
    return static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0));
  }

  // What was never seen is unlikely, not impossible.
  static void smooth(Histogram& histogram) {
    Histogram smoothed = histogram;
    for (std::size_t i = 2; i + 2 < kBins; ++i)
      smoothed[i] = 0.25 * histogram[i - 1] + 0.5 * histogram[i] + 0.25 * histogram[i + 1];
    double sum = 0.0;
    for (double& count : smoothed) sum += count += 0.3;
    for (double& count : smoothed) count /= sum;
    histogram = smoothed;
  }

  Histogram on_{};
  Histogram beside_{};
  Histogram ratios_{};
};

// What stands behind the edges, by cells of 11.5 mm along them.
class Background {
 public:
  static std::size_t cell(std::size_t edge, const PlateMeeting& at) {
    const double place_m = edge == 0 ? at.v : at.u;
    return kCells * edge +
           static_cast<std::size_t>(std::clamp((place_m + 0.06) / 0.0115, 0.0, kCells - 1.0));
  }
  void learn(std::size_t cell, double beyond_m) { balance_[cell] += beyond_m < kNear_m ? 1 : -1; }
  bool near(std::size_t cell) const { return balance_[cell] > 0; }

 private:
  static constexpr std::size_t kCells = 16;
  std::array<int, 3 * kCells> balance_{};
};

double inside_of_all(const std::array<double, 3>& inside_m) {
  return *std::min_element(inside_m.begin(), inside_m.end());
}

}  // namespace

PlateRanges ranges_on_plate(const std::vector<PlateBeam>& beams, std::size_t stride,
                            const PlateTriangle& triangle, const PlateFrame& frame) {
  std::vector<double> beyond_m;
  beyond_m.reserve(beams.size() / stride / 2);
  for (std::size_t index = 0; index < beams.size(); index += stride) {
    const PlateBeam& beam = beams[index];
    const PlateMeeting at = frame.meeting(beam);
    if (inside_of_all(triangle.inside_m(at.u, at.v)) < kSure_m) continue;
    beyond_m.push_back(beam.beyond_m - beam.range_per_height() * at.lift_m);
  }
  PlateRanges ranges;
  if (beyond_m.empty()) return ranges;
  const auto middle = beyond_m.begin() + static_cast<std::ptrdiff_t>(beyond_m.size() / 2);
  std::nth_element(beyond_m.begin(), middle, beyond_m.end());
  ranges.offset_m = *middle;
  double squares = 0.0;
  for (const double value : beyond_m) {
    const double off_m = value - ranges.offset_m;
    if (std::abs(off_m) > kOutlier_m) continue;
    squares += off_m * off_m;
    ++ranges.hits;
  }
  ranges.rms_m = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(ranges.hits, 1)));
  return ranges;
}

std::vector<EdgeBeam> edge_beams(const std::vector<PlateBeam>& beams, std::size_t stride,
                                 const PlateTriangle& triangle, const PlateParameters& parameters,
                                 double offset_m, double least_zone_m) {
  const PlateFrame frame(parameters, triangle.middle_m());
  Evidence evidence;
  Background background;
  std::vector<EdgeBeam> candidates;
  candidates.reserve(beams.size() / stride / 2);
  for (std::size_t index = 0; index < beams.size(); index += stride) {
    const PlateBeam& beam = beams[index];
    const PlateMeeting at = frame.meeting(beam);
    auto inside_m = triangle.inside_m(at.u, at.v);
    const auto edge = static_cast<std::size_t>(std::min_element(inside_m.begin(), inside_m.end()) -
                                               inside_m.begin());
    const double nearest_m = inside_m[edge];
    const double beyond_m = beam.beyond_m - beam.range_per_height() * at.lift_m - offset_m;
    const std::size_t cell = Background::cell(edge, at);
    if (std::abs(nearest_m) > kSure_m) evidence.learn(beyond_m, nearest_m > 0.0);
    if (nearest_m < -kSure_m) background.learn(cell, beyond_m);
    if (std::abs(nearest_m) > kWidestZone_m) continue;
    inside_m[edge] = 1.0;
    if (inside_of_all(inside_m) < kCornerZone_m) continue;
    candidates.push_back({beam, edge, cell, beyond_m});
  }
  evidence.finish();
  auto chosen = candidates.begin();
  for (EdgeBeam& beam : candidates) {
    beam.near = background.near(beam.cell);
    const EdgeDepth depth = depth_of(beam, frame.meeting(beam.beam), triangle, parameters);
    const double soft_m = frame.softness_m() * depth.slant;
    if (std::abs(depth.inside_m) > std::max(least_zone_m, kZone_softnesses * soft_m)) continue;
    const double ratio = evidence.ratio(beam.beyond_m);
    beam.odds = std::exp(ratio);
    beam.sureness = std::tanh(0.5 * std::abs(ratio));
    *chosen++ = beam;
  }
  candidates.erase(chosen, candidates.end());
  return candidates;
}

}  // namespace swivel
