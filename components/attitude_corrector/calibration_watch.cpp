#include "components/attitude_corrector/calibration_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calibration/in_words.hpp"

namespace swivel {
namespace {

// What one sweep shows may be chance; what three in a row show is not.
constexpr std::size_t kSweeps = 3;
// The edges look softer where the plate stands otherwise, and pull the less: a roll of 1 deg pulls
// by 1.7 in mode 1. Chance pulls by half a sigma.
constexpr double kMovedSigmas = 1.5;
constexpr double kResidualRatio = 1.3;
constexpr double kWidestSeam_rad = rad_from_deg(0.2);
constexpr double kSeamSigmas = 4.0;

struct Part {
  const char* name;
  Known PlateShape::*known;
};

constexpr std::array<Part, 4> kParts{
    Part{"height", &PlateShape::height_m}, Part{"roll", &PlateShape::roll_rad},
    Part{"pitch", &PlateShape::pitch_rad}, Part{"outline", &PlateShape::growth_m}};

// A sweep pulls what was known towards what it sees: by this many sigmas of what was known.
double pull(const Known& seen, const Known& known) {
  return (seen.value - known.value) / known.sigma;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void CalibrationWatch::calibrated(const std::optional<PlateShape>& shape, double plate_residual_m) {
  shape_ = shape;
  residual_m_ = plate_residual_m;
  last_.clear();
}

std::string CalibrationWatch::add(const AttitudeEstimate& estimate, const SeamEstimate& seam) {
  last_.push_back({estimate, seam});
  if (last_.size() > kSweeps) last_.pop_front();
  if (last_.size() < kSweeps) return {};
  for (const std::string& words : {plate_moved(), ranges_changed(), speed_changed()}) {
    if (!words.empty()) return words;
  }
  return {};
}

std::string CalibrationWatch::plate_moved() const {
  if (!shape_) return {};
  for (const Part& part : kParts) {
    std::vector<double> pulls;
    for (const Sweep& sweep : last_) {
      if (!sweep.estimate.fit) return {};
      pulls.push_back(pull(sweep.estimate.fit->shape.*part.known, (*shape_).*part.known));
    }
    const auto [least, most] = std::minmax_element(pulls.begin(), pulls.end());
    if (*least<kMovedSigmas&& * most> - kMovedSigmas) continue;
    return in_words("the plate's ", part.name, " is no longer as calibrated, in ", kSweeps,
                    " sweeps: was it knocked? Calibrate again");
  }
  return {};
}

std::string CalibrationWatch::ranges_changed() const {
  if (!(residual_m_ > 0.0)) return {};
  std::vector<double> residuals_m;
  for (const Sweep& sweep : last_) residuals_m.push_back(sweep.estimate.residual_m);
  const double now_m = median(residuals_m);
  if (!(now_m > kResidualRatio * residual_m_)) return {};
  return in_words("the plate's points lie ", mm_from_m(now_m), " mm about it, ",
                  mm_from_m(residual_m_),
                  " when calibrated: is lidar or plate dirty? Calibrate again");
}

std::string CalibrationWatch::speed_changed() const {
  double sum_rad = 0.0;
  for (const Sweep& sweep : last_) {
    const SeamEstimate& seam = sweep.seam;
    if (std::isnan(seam.further_rad)) return {};
    if (std::abs(seam.further_rad) < kSeamSigmas * seam.sigma_rad) return {};
    if (seam.further_rad * sum_rad < 0.0) return {};
    sum_rad += seam.further_rad;
  }
  const double mean_rad = sum_rad / static_cast<double>(kSweeps);
  if (std::abs(mean_rad) < kWidestSeam_rad) return {};
  return in_words("the shaft turns ", spoken_deg(mean_rad), " deg further than said, in ", kSweeps,
                  " sweeps: check the steps per turn of the controller");
}

}  // namespace swivel
