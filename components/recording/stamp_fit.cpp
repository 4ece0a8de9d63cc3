#include "components/recording/stamp_fit.hpp"

namespace swivel {
namespace {

struct Centre {
  double number = 0.0;
  double stamp_ns = 0.0;
};

Centre centre_of(const std::vector<StampedLine>& lines) {
  Centre centre;
  for (const StampedLine& line : lines) {
    centre.number += static_cast<double>(line.number) / static_cast<double>(lines.size());
    centre.stamp_ns += line.stamp_ns / static_cast<double>(lines.size());
  }
  return centre;
}

// Sums of squares about a sweep's own centre: they add up over sweeps that share the slope.
struct Spread {
  double numbers = 0.0;
  double stamps_by_numbers = 0.0;

  void add(const std::vector<StampedLine>& lines) {
    const Centre centre = centre_of(lines);
    for (const StampedLine& line : lines) {
      const double number = static_cast<double>(line.number) - centre.number;
      numbers += number * number;
      stamps_by_numbers += number * (line.stamp_ns - centre.stamp_ns);
    }
  }
};

double first_of(const std::vector<StampedLine>& lines, double period_ns) {
  const Centre centre = centre_of(lines);
  return centre.stamp_ns - centre.number * period_ns;
}

}  // namespace

StampFit fit_stamps(const std::vector<std::vector<StampedLine>>& sweeps, double nominal_period_ns) {
  Spread spread;
  for (const auto& lines : sweeps) spread.add(lines);
  StampFit fit;
  fit.period_ns =
      spread.numbers > 0.0 ? spread.stamps_by_numbers / spread.numbers : nominal_period_ns;
  for (const auto& lines : sweeps) fit.first_ns.push_back(first_of(lines, fit.period_ns));
  return fit;
}

double residual_ns(const StampFit& fit, std::size_t sweep, const StampedLine& line) {
  return line.stamp_ns - fit.first_ns[sweep] - static_cast<double>(line.number) * fit.period_ns;
}

}  // namespace swivel
