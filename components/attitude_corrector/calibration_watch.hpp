// Whether the calibration still fits what the sweeps show: a plate that was knocked, a motor that
// turns at another speed, a lidar that ages.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "calibration/attitude.hpp"
#include "calibration/seam.hpp"

namespace swivel {

class CalibrationWatch {
 public:
  // From now on; none where the calibration does not tell the plate's shape.
  void calibrated(const std::optional<PlateShape>& shape, double plate_residual_m);

  // One good sweep. Says why a new calibration is due, or nothing.
  std::string add(const AttitudeEstimate& estimate, const SeamEstimate& seam);

 private:
  struct Sweep {
    AttitudeEstimate estimate;
    SeamEstimate seam;
  };
  std::string plate_moved() const;
  std::string ranges_changed() const;
  std::string speed_changed() const;

  std::optional<PlateShape> shape_;
  double residual_m_ = 0.0;
  std::deque<Sweep> last_;
};

}  // namespace swivel
