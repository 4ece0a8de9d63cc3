// What the sweeps of a rig say of its mounting, in pictures: the roof under each step of the
// calibration, and the bias that each sweep shows.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/mounting.hpp"

namespace swivel {

class MountingPictures {
 public:
  // The folder must be there. title: what was scanned.
  MountingPictures(std::string folder, std::string title, const RigGeometry& nominal);

  // What was seen from one place, and its fit. Draws the roof, if there is one. Returns the mean
  // deviation of its points, by kRoofStepNames. Throws ExitError.
  std::optional<std::vector<double>> add(std::size_t sweep, const SweepReadings& readings,
                                         const MountingFit& fit);

  // What a simulator says of a sweep's bias; none where not known.
  using TrueBias = std::function<std::optional<double>(std::size_t sweep)>;

  // Draws the bias of all sweeps so far, if they are several or the truth is known. Returns the
  // path, or nothing. Throws ExitError.
  std::string draw_biases(const TrueBias& true_bias_deg) const;

  struct Roof {
    std::size_t sweep = 0;
    std::string steps_path;
    std::string deviations_path;
  };
  const std::vector<Roof>& roofs() const { return roofs_; }

 private:
  struct Bias {
    std::size_t sweep = 0;
    SymmetricRaysFit symmetric_rays;
    double joint_rad = 0.0;
    double joint_sigma_rad = 0.0;
  };

  std::string folder_;
  std::string title_;
  RigGeometry nominal_;
  std::vector<Roof> roofs_;
  std::vector<Bias> biases_;  // of those that show it
};

}  // namespace swivel
