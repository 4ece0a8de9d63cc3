// Where a beam meets the plate and its outline, for a plate that does not stand quite as drawn.
// docs/geometry.md (14).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "calibration/plate_beams.hpp"
#include "calibration/rig.hpp"

namespace swivel {

// What is fitted. kGrowthNear is the growth of edges before something that stands close behind.
enum PlateParameter {
  kBeta,
  kHeight,
  kRoll,
  kPitch,
  kGrowth,
  kLogSoftness,
  kGrowthNear,
  kPlateParameters
};
using PlateParameters = Eigen::Matrix<double, kPlateParameters, 1>;

// The drawn outline: base edge and two legs, in the plate's own frame, u along its middle line.
class PlateTriangle {
 public:
  explicit PlateTriangle(const PlateGeometry& plate)
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
struct PlateMeeting {
  double u = 0.0;
  double v = 0.0;
  double slope_u = 0.0;
  double slope_v = 0.0;
  double lift_m = 0.0;  // of the plate there, above the drawn plane
};

class PlateFrame {
 public:
  PlateFrame(const PlateParameters& parameters, double middle_m)
      : parameters_(parameters),
        cos_(std::cos(parameters[kBeta])),
        sin_(std::sin(parameters[kBeta])),
        middle_m_(middle_m),
        softness_m_(std::exp(parameters[kLogSoftness])) {}

  double softness_m() const { return softness_m_; }

  PlateMeeting meeting(const PlateBeam& beam) const {
    PlateMeeting at;
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
  PlateParameters parameters_;
  double cos_;
  double sin_;
  double middle_m_;
  double softness_m_;
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

// How far inside of its edge a beam is, as the parameters have it: in metres, and against how
// sharply the edge is seen there.
struct EdgeDepth {
  double inside_m;
  double by_height;
  double slant;  // by how much the spot is longer across the edge than it is wide
};

inline EdgeDepth depth_of(const EdgeBeam& edge, const PlateMeeting& at,
                          const PlateTriangle& triangle, const PlateParameters& parameters) {
  EdgeDepth depth{};
  depth.by_height = PlateTriangle::into(edge.edge, at.slope_u, at.slope_v);
  depth.slant = std::sqrt(1.0 + depth.by_height * depth.by_height);
  depth.inside_m = triangle.inside_m(at.u, at.v)[edge.edge] +
                   parameters[edge.near ? kGrowthNear : kGrowth] * depth.slant;
  return depth;
}

}  // namespace swivel
