// A reason, put together of words and numbers.
#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "calibration/units.hpp"

namespace swivel {

template <typename... Parts>
std::string in_words(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

// An angle as it is said: in degrees, to a hundredth.
inline double spoken_deg(double angle_rad) {
  return std::round(deg_from_rad(angle_rad) * 100.0) / 100.0;
}

}  // namespace swivel
