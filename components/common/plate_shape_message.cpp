#include "components/common/plate_shape_message.hpp"

#include <array>
#include <cmath>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr double kDegPerRad = deg_from_rad(1.0);
constexpr double kMmPerM = mm_from_m(1.0);

// In the order of the IDL. The softness is told in mm, with its sigma as a part of it.
constexpr std::size_t kSoftness = 4;

std::array<Known, 6> values_in_order(const PlateShape& shape) {
  return {shape.height_m, shape.roll_rad,     shape.pitch_rad,
          shape.growth_m, shape.log_softness, shape.range_offset_m};
}

constexpr std::array<double, 6> kUnits{kMmPerM, kDegPerRad, kDegPerRad, kMmPerM, 1.0, kMmPerM};

Known to_wire(const Known& known, std::size_t index) {
  if (index != kSoftness) return {known.value * kUnits[index], known.sigma * kUnits[index]};
  const double softness_mm = mm_from_m(std::exp(known.value));
  return {softness_mm, softness_mm * known.sigma};
}

Known from_wire(double value, double sigma, std::size_t index) {
  if (index != kSoftness) return {value / kUnits[index], sigma / kUnits[index]};
  return {std::log(m_from_mm(value)), sigma / value};
}

}  // namespace

void to_message(const LearnedPlate& plate, msg::Calibration& calibration) {
  const auto shape = values_in_order(plate.shape);
  for (std::size_t index = 0; index < shape.size(); ++index) {
    const Known known = to_wire(shape[index], index);
    calibration.plate_shape()[index] = known.value;
    calibration.plate_shape_sigma()[index] = known.sigma;
  }
  calibration.plate_residual_mm(mm_from_m(plate.residual_m));
}

std::optional<PlateShape> plate_shape_of(const msg::Calibration& calibration) {
  std::array<Known, 6> shape{};
  for (std::size_t index = 0; index < shape.size(); ++index) {
    const double sigma = calibration.plate_shape_sigma()[index];
    if (!(sigma > 0.0)) return std::nullopt;
    shape[index] = from_wire(calibration.plate_shape()[index], sigma, index);
    if (!std::isfinite(shape[index].value) || !std::isfinite(shape[index].sigma))
      return std::nullopt;
  }
  return PlateShape{shape[0], shape[1], shape[2], shape[3], shape[4], shape[5]};
}

}  // namespace swivel
