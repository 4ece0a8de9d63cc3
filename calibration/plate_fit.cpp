#include "calibration/plate_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace swivel {
namespace {

// What is fitted. kGrowthNear is the growth of edges before something that stands close behind.
enum Parameter { kBeta, kHeight, kRoll, kPitch, kGrowth, kLogSoftness, kGrowthNear, kParameters };
using Parameters = Eigen::Matrix<double, kParameters, 1>;
using Information = Eigen::Matrix<double, kParameters, kParameters>;
using KnownBefore = std::array<Known, kParameters>;

constexpr double kCornerZone_m = 0.007;    // two edges nearer than this make a corner
constexpr double kSure_m = 0.007;          // beams further from the outline are sure of their side
constexpr double kOutlier_m = 0.08;        // off the plate: not measured on it
constexpr double kFlip = 0.01;             // of beams that say the wrong thing, whatever they saw
constexpr double kClip = 12.0;             // of a log-likelihood ratio
constexpr double kLargestTurn_rad = 0.02;  // in one step
constexpr double kLargestSoftening = 1.0;  // likewise, of the logarithm
constexpr double kConverged = 0.001;       // square of a step, in sigmas
constexpr double kSharpest_m = 0.00003;    // softness: finer than the beams lie
constexpr double kSoftStart_m = 0.002;     // so that a first azimuth beside the edge finds it

// A surface this close behind an edge answers along with it, and the edge looks otherwise. Such
// edges have a growth of their own and little to say.
constexpr double kNear_m = 0.15;
constexpr double kNearTrust = 0.1;
constexpr Known kNearGrowth_m{0.0, 0.002};

// First coarsely, from an azimuth that is a degree off, on some of the beams; then with all.
struct Round {
  std::size_t most_beams;
  double least_zone_m;  // beams further from the outline know nothing of it
  int most_iterations;
};
constexpr std::array<Round, 2> kRounds{Round{6000, 0.014, 10}, Round{100'000, 0.0025, 15}};
constexpr double kZone_softnesses = 4.0;
constexpr double kWidestZone_m = 0.014;

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x * std::sqrt(0.5));
}

double normal_density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * kPi);
}

// The drawn outline: base edge and two legs, in the plate's own frame, u along its middle line.
class Triangle {
 public:
  explicit Triangle(const PlateGeometry& plate)
      : base_m_(plate.base_distance_m),
        tip_m_(plate.base_distance_m + plate.hypotenuse_m / 2),
        middle_m_(plate.base_distance_m + plate.hypotenuse_m / 6) {}

  double middle_m() const { return middle_m_; }

  // Distance inside of the edge (0 the base, 1 the left leg, 2 the right leg).
  std::array<double, 3> inside_m(double u, double v) const {
    constexpr double kHalf = 0.70710678118654752;
    return {u - base_m_, kHalf * (tip_m_ - u - v), kHalf * (tip_m_ - u + v)};
  }

  // The same of a direction.
  static double into(std::size_t edge, double u, double v) {
    constexpr double kHalf = 0.70710678118654752;
    return edge == 0 ? u : kHalf * (edge == 1 ? -u - v : -u + v);
  }

 private:
  double base_m_;
  double tip_m_;
  double middle_m_;
};

// Where a beam meets the plate as the parameters have it, and how that changes with them.
struct Meeting {
  double u = 0.0;
  double v = 0.0;
  double slope_u = 0.0;
  double slope_v = 0.0;
  double lift_m = 0.0;  // of the plate there, above the drawn plane
};

class Frame {
 public:
  Frame(const Parameters& parameters, double middle_m)
      : parameters_(parameters),
        cos_(std::cos(parameters[kBeta])),
        sin_(std::sin(parameters[kBeta])),
        middle_m_(middle_m) {}

  Meeting meeting(const PlateBeam& beam) const {
    Meeting at;
    at.u = cos_ * beam.x_m + sin_ * beam.y_m;
    at.v = -sin_ * beam.x_m + cos_ * beam.y_m;
    at.slope_u = cos_ * beam.slope_x + sin_ * beam.slope_y;
    at.slope_v = -sin_ * beam.slope_x + cos_ * beam.slope_y;
    at.lift_m =
        parameters_[kHeight] + parameters_[kRoll] * at.v + parameters_[kPitch] * (at.u - middle_m_);
    at.u += at.slope_u * at.lift_m;
    at.v += at.slope_v * at.lift_m;
    return at;
  }

 private:
  const Parameters& parameters_;
  double cos_;
  double sin_;
  double middle_m_;
};

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
  static std::size_t cell(std::size_t edge, const Meeting& at) {
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

// A beam near one edge, and what it says.
struct EdgeBeam {
  PlateBeam beam;
  std::size_t edge = 0;
  std::size_t cell = 0;
  double beyond_m = 0.0;
  double odds = 1.0;      // that it is on the plate, by its range alone
  double sureness = 0.0;  // of that, 0 to 1
  bool near = false;
};

struct Normal {
  Information information = Information::Zero();
  Parameters gradient = Parameters::Zero();
  double misfit = 0.0;  // sum of squared residuals, by their variance
};

double inside_of_all(const std::array<double, 3>& inside_m) {
  return *std::min_element(inside_m.begin(), inside_m.end());
}

std::vector<PlateBeam> some_of(const std::vector<PlateBeam>& beams, std::size_t most) {
  const std::size_t stride = 1 + beams.size() / most;
  std::vector<PlateBeam> some;
  some.reserve(beams.size() / stride + 1);
  for (std::size_t i = 0; i < beams.size(); i += stride) some.push_back(beams[i]);
  return some;
}

// How far the ranges are off the plate where it surely is: their median, and the rms about it.
struct Ranges {
  double offset_m = 0.0;
  double rms_m = 0.0;
  std::size_t hits = 0;
};

Ranges ranges_on_plate(const std::vector<PlateBeam>& beams, const Triangle& triangle,
                       const Frame& frame) {
  std::vector<double> beyond_m;
  for (const PlateBeam& beam : beams) {
    const Meeting at = frame.meeting(beam);
    if (inside_of_all(triangle.inside_m(at.u, at.v)) < kSure_m) continue;
    beyond_m.push_back(beam.beyond_m - beam.range_per_height * at.lift_m);
  }
  Ranges ranges;
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

// How far inside of its edge a beam is, as the parameters have it: in metres, and against how
// sharply the edge is seen there.
struct Depth {
  double inside_m;
  double by_height;
  double slant;  // by how much the spot is longer across the edge than it is wide
};

Depth depth_of(const EdgeBeam& edge, const Meeting& at, const Triangle& triangle,
               const Parameters& parameters) {
  Depth depth{};
  depth.by_height = Triangle::into(edge.edge, at.slope_u, at.slope_v);
  depth.slant = std::sqrt(1.0 + depth.by_height * depth.by_height);
  depth.inside_m = triangle.inside_m(at.u, at.v)[edge.edge] +
                   parameters[edge.near ? kGrowthNear : kGrowth] * depth.slant;
  return depth;
}

// The beams near one edge alone, and what their ranges say: that is learned from all the others.
std::vector<EdgeBeam> edge_beams(const std::vector<PlateBeam>& beams, const Triangle& triangle,
                                 const Parameters& parameters, double offset_m,
                                 double least_zone_m) {
  const Frame frame(parameters, triangle.middle_m());
  Evidence evidence;
  Background background;
  std::vector<EdgeBeam> candidates;
  for (const PlateBeam& beam : beams) {
    const Meeting at = frame.meeting(beam);
    auto inside_m = triangle.inside_m(at.u, at.v);
    const auto edge = static_cast<std::size_t>(std::min_element(inside_m.begin(), inside_m.end()) -
                                               inside_m.begin());
    const double nearest_m = inside_m[edge];
    const double beyond_m = beam.beyond_m - beam.range_per_height * at.lift_m - offset_m;
    const std::size_t cell = Background::cell(edge, at);
    if (std::abs(nearest_m) > kSure_m) evidence.learn(beyond_m, nearest_m > 0.0);
    if (nearest_m < -kSure_m) background.learn(cell, beyond_m);
    if (std::abs(nearest_m) > kWidestZone_m) continue;
    inside_m[edge] = 1.0;
    if (inside_of_all(inside_m) < kCornerZone_m) continue;
    candidates.push_back({beam, edge, cell, beyond_m});
  }
  evidence.finish();
  std::vector<EdgeBeam> chosen;
  for (EdgeBeam& beam : candidates) {
    beam.near = background.near(beam.cell);
    const Depth depth = depth_of(beam, frame.meeting(beam.beam), triangle, parameters);
    const double soft_m = std::exp(parameters[kLogSoftness]) * depth.slant;
    if (std::abs(depth.inside_m) > std::max(least_zone_m, kZone_softnesses * soft_m)) continue;
    const double ratio = evidence.ratio(beam.beyond_m);
    beam.odds = std::exp(ratio);
    beam.sureness = std::tanh(0.5 * std::abs(ratio));
    chosen.push_back(beam);
  }
  return chosen;
}

// Eqs. (15) and (16): the gradient of the log-likelihood of one beam, and Fisher's information.
void add_beam(const EdgeBeam& edge, const Triangle& triangle, const Frame& frame,
              const Parameters& parameters, Normal& normal) {
  const Meeting at = frame.meeting(edge.beam);
  const Parameter growth = edge.near ? kGrowthNear : kGrowth;
  const auto [inside_m, by_height, slant] = depth_of(edge, at, triangle, parameters);
  const double softness_m = std::exp(parameters[kLogSoftness]) * slant;
  const double x = inside_m / softness_m;
  const double chance = kFlip + (1.0 - 2.0 * kFlip) * normal_cdf(x);
  const double steepness = (1.0 - 2.0 * kFlip) * normal_density(x);
  const double variance = chance * (1.0 - chance);
  const double hit = chance * edge.odds / (chance * edge.odds + 1.0 - chance);

  Parameters by = Parameters::Zero();
  by[kBeta] = Triangle::into(edge.edge, at.v, -at.u);
  by[kHeight] = by_height;
  by[kRoll] = by_height * at.v;
  by[kPitch] = by_height * (at.u - triangle.middle_m());
  by[growth] = slant;
  by[kLogSoftness] = -x * softness_m;
  by *= steepness / softness_m;
  const double trust = edge.near ? kNearTrust : 1.0;
  const double known = edge.sureness * edge.sureness;
  normal.information += (trust * known / variance) * by * by.transpose();
  normal.gradient += (trust * (hit - chance) / variance) * by;
  normal.misfit += (hit - chance) * (hit - chance) / variance;
}

KnownBefore known_before(const PlateShape& shape, double beta_rad) {
  KnownBefore known;
  known[kBeta] = {beta_rad, 2 * kPi};
  known[kHeight] = shape.height_m;
  known[kRoll] = shape.roll_rad;
  known[kPitch] = shape.pitch_rad;
  known[kGrowth] = shape.growth_m;
  known[kLogSoftness] = shape.log_softness;
  known[kGrowthNear] = kNearGrowth_m;
  return known;
}

Normal normal_equations(const std::vector<EdgeBeam>& beams, const Triangle& triangle,
                        const KnownBefore& before, const Parameters& parameters) {
  const Frame frame(parameters, triangle.middle_m());
  Normal normal;
  for (const EdgeBeam& beam : beams) add_beam(beam, triangle, frame, parameters, normal);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double precision = 1.0 / (before[i].sigma * before[i].sigma);
    normal.information(row, row) += precision;
    normal.gradient[row] += precision * (before[i].value - parameters[row]);
  }
  return normal;
}

// Fisher scoring. Returns the covariance; none if it does not come to rest.
std::optional<Information> climb(const std::vector<EdgeBeam>& beams, const Triangle& triangle,
                                 const KnownBefore& before, int most_iterations,
                                 Parameters& parameters, double& misfit) {
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Normal normal = normal_equations(beams, triangle, before, parameters);
    const Information covariance = normal.information.inverse();
    Parameters step = covariance * normal.gradient;
    misfit = normal.misfit / static_cast<double>(std::max<std::size_t>(beams.size(), 1));
    if (!step.allFinite()) return std::nullopt;
    step[kBeta] = std::clamp(step[kBeta], -kLargestTurn_rad, kLargestTurn_rad);
    step[kLogSoftness] = std::clamp(step[kLogSoftness], -kLargestSoftening, kLargestSoftening);
    step[kLogSoftness] =
        std::max(step[kLogSoftness], std::log(kSharpest_m) - parameters[kLogSoftness]);
    parameters += step;
    if (step.dot(normal.information * step) < kConverged) return covariance;
  }
  return std::nullopt;
}

PlateShape shape_of(const Parameters& parameters, const Information& covariance,
                    const Ranges& ranges) {
  const auto told = [&](Parameter index) {
    return Known{parameters[index], std::sqrt(covariance(index, index))};
  };
  const double mean_sigma_m =
      1.25 * ranges.rms_m / std::sqrt(static_cast<double>(std::max<std::size_t>(ranges.hits, 1)));
  return {told(kHeight), told(kRoll),        told(kPitch),
          told(kGrowth), told(kLogSoftness), {ranges.offset_m, mean_sigma_m}};
}

}  // namespace

std::optional<PlateFit> fit_plate(const std::vector<PlateBeam>& beams, const PlateGeometry& plate,
                                  double beta_rad) {
  const Triangle triangle(plate);
  const KnownBefore before = known_before(plate.shape, beta_rad);
  Parameters parameters;
  for (std::size_t i = 0; i < before.size(); ++i)
    parameters[static_cast<Eigen::Index>(i)] = before[i].value;
  parameters[kLogSoftness] = std::max(parameters[kLogSoftness], std::log(kSoftStart_m));

  PlateFit fit;
  Ranges ranges;
  std::optional<Information> covariance;
  for (const Round& round : kRounds) {
    const auto some = some_of(beams, round.most_beams);
    ranges = ranges_on_plate(some, triangle, Frame(parameters, triangle.middle_m()));
    const auto chosen = edge_beams(some, triangle, parameters, ranges.offset_m, round.least_zone_m);
    fit.edge_beams = chosen.size();
    covariance = climb(chosen, triangle, before, round.most_iterations, parameters, fit.misfit);
  }
  if (!covariance) return std::nullopt;
  fit.beta_rad = parameters[kBeta];
  fit.beta_sigma_rad = std::sqrt((*covariance)(kBeta, kBeta));
  fit.shape = shape_of(parameters, *covariance, ranges);
  fit.residual_m = ranges.rms_m;
  fit.hits = ranges.hits;
  return fit;
}

}  // namespace swivel
