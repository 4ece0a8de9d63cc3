// The figures 9, 10 and 11 of Yuan 2021, as PNG.
#pragma once

#include <string>
#include <vector>

#include "components/swivel/report/evaluation.hpp"
#include "hardware/result.hpp"

namespace swivel {

// Fig. 9: phi_error of every sweep without correction (vermillion) and with it (blue); below, the
// latter alone with the sigma that was said. A sweep without attitude has a cross, no blue dot.
Outcome write_sweeps_chart(const std::string& path, const std::string& title,
                           const std::vector<SweepAttitude>& attitudes);

// Fig. 10: least, mean and largest phi_error of every mode.
Outcome write_modes_chart(const std::string& path, const std::string& title,
                          const std::vector<ModeEvaluation>& modes);

// Fig. 11: a panel a mode, the map's error over distance between least and largest phi_error,
// and the distance up to which it stays within +-50 mm.
Outcome write_map_error_chart(const std::string& path, const std::string& title,
                              const std::vector<ModeEvaluation>& modes);

}  // namespace swivel
