#include "components/swivel/pictures/mounting_charts.hpp"

#include <algorithm>
#include <cmath>

#include "components/swivel/pictures/chart.hpp"

namespace swivel {
namespace {

constexpr int kRoofPaperWidth = 1200;
constexpr int kRoofPaperLeft = 90;
constexpr std::size_t kMostRoofSpecks = 8000;  // more say no more
constexpr double kLeastShown_mm = 40.0;

// So many of the values, by size, are no larger.
double size_of_share_mm(const std::vector<double>& off_m, double share) {
  std::vector<double> sizes_mm;
  sizes_mm.reserve(off_m.size());
  for (const double off : off_m) sizes_mm.push_back(mm_from_m(std::abs(off)));
  if (sizes_mm.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes_mm.size() - 1));
  std::nth_element(sizes_mm.begin(), sizes_mm.begin() + place, sizes_mm.end());
  return sizes_mm[static_cast<std::size_t>(place)];
}

double furthest_m(const std::vector<double>& along_m) {
  double furthest = 0.1;
  for (const double along : along_m) furthest = std::max(furthest, std::abs(along));
  return furthest;
}

void draw_roof_panel(Paper& paper, const cv::Rect& area, const RoofLook& look, std::size_t step,
                     double shown_mm) {
  const double reach_m = 1.05 * furthest_m(look.along_m);
  Chart chart(paper, area, {-reach_m, reach_m}, {-shown_mm, shown_mm});
  const std::vector<double>& off_m = look.off_m[step];
  chart.draw_axes("along the scan line, m",
                  std::string("off the plane, mm: ") + kRoofStepNames[step] + ", mean " +
                      with_decimals(mm_from_m(mean_deviation_m(off_m)), 1));
  const std::size_t stride = 1 + off_m.size() / kMostRoofSpecks;
  for (std::size_t ray = 0; ray < off_m.size(); ray += stride) {
    chart.speck(look.along_m[ray], mm_from_m(off_m[ray]), ray < look.front ? kBlue : kVermillion);
  }
  chart.line(-reach_m, 0.0, reach_m, 0.0, kGrey, 1);
}

}  // namespace

Outcome write_roof_chart(const std::string& path, const std::string& title, const RoofLook& look) {
  Paper paper(kRoofPaperWidth, 860);
  paper.write(title, {kRoofPaperLeft, 36}, 26, kBlack);
  paper.write_legend({{kBlue, "first half of the turn"}, {kVermillion, "the half that follows"}},
                     {kRoofPaperLeft, 70});
  const double shown_mm =
      std::max(kLeastShown_mm, 1.2 * size_of_share_mm(look.off_m.front(), 0.998));
  for (std::size_t step = 0; step < kRoofSteps; ++step) {
    const int left = kRoofPaperLeft + (step % 2 == 0 ? 0 : 570);
    const int top = 120 + (step < 2 ? 0 : 370);
    draw_roof_panel(paper, {left, top, 470, 270}, look, step, shown_mm);
  }
  paper.write(
      "each point is a ray to the roof, or to the floor; a bias of the centreline bends "
      "it, the noise alone is level",
      {kRoofPaperLeft, 840}, 17, kGrey);
  return paper.save(path);
}

namespace {

// How dense the values lie over a grid of whole millimetres, % a millimetre: a normal
// distribution in each one's place, as wide as Silverman's rule says.
class Density {
 public:
  Density(std::vector<double>::const_iterator first, std::vector<double>::const_iterator end,
          double shown_mm)
      : shown_mm_(std::ceil(shown_mm)),
        counts_(static_cast<std::size_t>(2.0 * shown_mm_) + 1, 0.0) {
    double squares = 0.0;
    for (auto off_m = first; off_m != end; ++off_m) {
      const double bin = std::round(mm_from_m(*off_m) + shown_mm_);
      squares += std::pow(mm_from_m(*off_m), 2);
      if (bin >= 0.0 && bin < static_cast<double>(counts_.size()))
        counts_[static_cast<std::size_t>(bin)] += 1.0;
    }
    all_ = std::max(1.0, static_cast<double>(end - first));
    width_mm_ = std::max(0.5, 1.06 * std::sqrt(squares / all_) * std::pow(all_, -0.2));
  }

  double at(double off_mm) const {
    double sum = 0.0;
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      const double widths = (off_mm - (static_cast<double>(bin) - shown_mm_)) / width_mm_;
      sum += counts_[bin] * std::exp(-0.5 * widths * widths);
    }
    return 100.0 * sum / (all_ * width_mm_ * std::sqrt(2.0 * kPi));
  }
  double most() const {
    double most = 0.0;
    for (double off_mm = -shown_mm_; off_mm <= shown_mm_; off_mm += 1.0)
      most = std::max(most, at(off_mm));
    return most;
  }
  void draw(Chart& chart, const Colour& colour) const {
    for (double off_mm = -shown_mm_; off_mm < shown_mm_; off_mm += 1.0)
      chart.line(off_mm, at(off_mm), off_mm + 1.0, at(off_mm + 1.0), colour, 3);
  }

 private:
  double shown_mm_;
  std::vector<double> counts_;
  double all_ = 1.0;
  double width_mm_ = 1.0;
};

Density density_of_half(const RoofLook& look, std::size_t step, bool front, double shown_mm) {
  const std::vector<double>& off_m = look.off_m[step];
  const auto middle = off_m.begin() + static_cast<std::ptrdiff_t>(look.front);
  return front ? Density(off_m.begin(), middle, shown_mm) : Density(middle, off_m.end(), shown_mm);
}

}  // namespace

Outcome write_deviations_chart(const std::string& path, const std::string& title,
                               const RoofLook& look) {
  Paper paper(kRoofPaperWidth, 520);
  paper.write(title, {kRoofPaperLeft, 36}, 26, kBlack);
  paper.write_legend({{kVermillion, kRoofStepNames.front()}, {kBlue, "calibrated"}},
                     {kRoofPaperLeft, 70});
  const double shown_mm =
      std::max(kLeastShown_mm, 1.2 * size_of_share_mm(look.off_m.front(), 0.99));
  for (const bool front : {true, false}) {
    const Density before = density_of_half(look, 0, front, shown_mm);
    const Density after = density_of_half(look, kRoofSteps - 1, front, shown_mm);
    const double most = 1.15 * std::max({before.most(), after.most(), 0.1});
    Chart chart(paper, {kRoofPaperLeft + (front ? 0 : 570), 120, 470, 310}, {-shown_mm, shown_mm},
                {0.0, most});
    chart.draw_axes("off the plane, mm",
                    front ? "first half of the turn, % a mm" : "the half that follows, % a mm");
    for (const double bound_mm : {-15.0, 15.0})
      chart.dashed(bound_mm, 0.0, bound_mm, most, kGrey, 1);
    before.draw(chart, kVermillion);
    after.draw(chart, kBlue);
  }
  paper.write("dashed: +-15 mm, within which most lie in the paper's fig. 11",
              {kRoofPaperLeft, 505}, 17, kGrey);
  return paper.save(path);
}

namespace {

using BiasValue = double FoundBias::*;

void draw_biases(Chart& chart, const std::vector<FoundBias>& biases, BiasValue value,
                 BiasValue sigma, bool less_truth, const Colour& colour, double aside) {
  for (std::size_t place = 0; place < biases.size(); ++place) {
    const FoundBias& bias = biases[place];
    const double y = bias.*value - (less_truth ? bias.true_deg : 0.0);
    if (!std::isfinite(y)) continue;
    const double x = static_cast<double>(place) + aside;
    if (std::isfinite(bias.*sigma)) {
      chart.line(x, y - bias.*sigma, x, y + bias.*sigma, colour, 3);
    }
    chart.dot(x, y, colour, 6);
  }
}

Span span_of_biases(const std::vector<FoundBias>& biases, bool less_truth, double least_deg) {
  double lowest = 0.0;
  double highest = 0.0;
  for (const FoundBias& bias : biases) {
    const double truth = less_truth ? bias.true_deg : 0.0;
    for (const auto& [value, sigma] :
         {std::pair{bias.symmetric_rays_deg, bias.symmetric_rays_sigma_deg},
          std::pair{bias.joint_deg, bias.joint_sigma_deg}}) {
      lowest = std::fmin(lowest, value - truth - sigma);
      highest = std::fmax(highest, value - truth + sigma);
    }
  }
  return span_of(lowest, highest, least_deg);
}

void draw_bias_panel(Paper& paper, const cv::Rect& area, const std::vector<FoundBias>& biases,
                     bool less_truth, const std::string& name) {
  const Span across{-0.6, static_cast<double>(biases.size()) - 0.4};
  Chart chart(paper, area, across, span_of_biases(biases, less_truth, less_truth ? 0.01 : 1.0));
  chart.draw_axes("", name);
  chart.line(across.lowest, 0.0, across.highest, 0.0, kGrey, 1);
  draw_biases(chart, biases, &FoundBias::symmetric_rays_deg, &FoundBias::symmetric_rays_sigma_deg,
              less_truth, kOrange, -0.08);
  draw_biases(chart, biases, &FoundBias::joint_deg, &FoundBias::joint_sigma_deg, less_truth, kBlue,
              0.08);
  for (std::size_t place = 0; place < biases.size(); ++place) {
    const int column = chart.at(static_cast<double>(place), 0.0).x;
    paper.write_centred("sweep " + std::to_string(biases[place].sweep), {column, area.br().y + 20},
                        16, kBlack);
  }
}

}  // namespace

Outcome write_bias_chart(const std::string& path, const std::string& title,
                         const std::vector<FoundBias>& biases) {
  const bool judged = std::any_of(biases.begin(), biases.end(), [](const FoundBias& bias) {
    return std::isfinite(bias.true_deg);
  });
  Paper paper(kRoofPaperWidth, judged ? 800 : 460);
  paper.write(title, {kRoofPaperLeft, 36}, 26, kBlack);
  paper.write_legend({{kOrange, "symmetric rays alone (algorithm 1)"}, {kBlue, "joint"}},
                     {kRoofPaperLeft, 70});
  const cv::Rect area(kRoofPaperLeft, 120, kRoofPaperWidth - kRoofPaperLeft - 40, 260);
  draw_bias_panel(paper, area, biases, false, "bias of the centreline, deg");
  if (judged) {
    draw_bias_panel(paper, area + cv::Point(0, 340), biases, true,
                    "the same less the simulator's truth, deg; the bars are one sigma either way");
  }
  return paper.save(path);
}

}  // namespace swivel
