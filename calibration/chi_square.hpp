// Whether values scatter as their sigmas foretell.
#pragma once

#include <algorithm>
#include <cmath>

namespace swivel {

struct ChiSquare {
  double sum = 0.0;
  double freedom = 0.0;

  // Sigmas are widened by as much as the scatter is more than they foretell.
  double widening() const { return freedom > 0.0 ? std::max(1.0, std::sqrt(sum / freedom)) : 1.0; }

  // Not larger than chance makes it once in a thousand times. Wilson and Hilferty's: the cube root
  // is nearly normal.
  bool by_chance() const {
    constexpr double kOneInAThousand = 3.09;
    if (freedom <= 0.0) return true;
    const double variance = 2.0 / (9.0 * freedom);
    return std::cbrt(sum / freedom) <= 1.0 - variance + kOneInAThousand * std::sqrt(variance);
  }
};

}  // namespace swivel
