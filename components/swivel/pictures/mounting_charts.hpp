// What a calibration of the mounting does to the roof: the figures 7, 10 and 11 of Zeng 2018, as
// PNG.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/roof_steps.hpp"
#include "components/swivel/report/evaluation.hpp"
#include "hardware/result.hpp"

namespace swivel {

// Fig. 10: a panel a step, how far the roof's points lie off their plane along the scan lines. The
// first half of the turn is blue, the half that follows vermillion.
Outcome write_roof_chart(const std::string& path, const std::string& title, const RoofLook& look);

// Fig. 11: a panel a half, how dense the deviations lie before (vermillion) and after (blue).
Outcome write_deviations_chart(const std::string& path, const std::string& title,
                               const RoofLook& look);

// Of one sweep. NaN where not known.
struct FoundBias {
  std::size_t sweep = 0;
  double symmetric_rays_deg = kUnknownAngle;
  double symmetric_rays_sigma_deg = kUnknownAngle;
  double joint_deg = kUnknownAngle;
  double joint_sigma_deg = kUnknownAngle;
  double true_deg = kUnknownAngle;
};

// Fig. 7: the bias that each sweep shows, by symmetric rays alone (orange) and jointly (blue);
// below, where the truth is known, how far off both are.
Outcome write_bias_chart(const std::string& path, const std::string& title,
                         const std::vector<FoundBias>& biases);

}  // namespace swivel
