#include "components/swivel/pictures/attitude_charts.hpp"

#include <algorithm>
#include <cmath>

#include "components/swivel/pictures/chart.hpp"

namespace swivel {
namespace {

constexpr int kWidth = 1200;
constexpr int kLeft = 90;
constexpr const char* kSign =
    "phi_error is positive where the cloud lies clockwise of where it should, seen from above";

const Colour kPaleBlue(238, 220, 200);
const Colour kPaleVermillion(214, 226, 250);
const Colour kPaleGrey(242, 242, 242);

std::string mode_name(int mode) {
  return mode == 0 ? "no mode" : "mode " + std::to_string(mode);
}

Span span_of_errors(const std::vector<double>& errors_deg, double least_deg) {
  const auto known = [](double one, double other) { return std::isnan(one) ? other : one; };
  double lowest = 0.0, highest = 0.0;
  for (const double error : errors_deg) {
    lowest = std::min(lowest, known(error, 0.0));
    highest = std::max(highest, known(error, 0.0));
  }
  return span_of(lowest, highest, least_deg);
}

void begin(Paper& paper, const std::string& title, const std::vector<LegendEntry>& legend) {
  paper.write(title, {kLeft, 36}, 26, kBlack);
  paper.write_legend(legend, {kLeft, 70});
}

// Sweeps side by side, those of a mode together.
std::vector<SweepAttitude> sorted_by_mode(std::vector<SweepAttitude> attitudes) {
  std::stable_sort(attitudes.begin(), attitudes.end(),
                   [](const auto& one, const auto& other) { return one.mode < other.mode; });
  return attitudes;
}

// Names and bounds of the modes below a chart of sweeps.
void draw_mode_segments(Chart& chart, const std::vector<SweepAttitude>& attitudes) {
  const cv::Rect& area = chart.area();
  for (std::size_t first = 0; first < attitudes.size();) {
    std::size_t end = first;
    while (end < attitudes.size() && attitudes[end].mode == attitudes[first].mode) ++end;
    const int left = chart.at(static_cast<double>(first) - 0.5, 0.0).x;
    const int right = chart.at(static_cast<double>(end) - 0.5, 0.0).x;
    if (first > 0) chart.paper().pixels()(cv::Rect(left, area.y, 1, area.height + 24)) = kGrey;
    std::string name = mode_name(attitudes[first].mode);
    if (chart.paper().width_of(name, 16) > right - left) name = name.substr(name.rfind(' ') + 1);
    chart.paper().write_centred(name, {(left + right) / 2, area.br().y + 20}, 16, kBlack);
    first = end;
  }
}

using Error = double SweepAttitude::*;

// Dots joined by a line, within a mode.
void draw_errors(Chart& chart, const std::vector<SweepAttitude>& attitudes, Error error,
                 const Colour& colour) {
  const auto error_deg = [&](std::size_t place) { return deg_from_rad(attitudes[place].*error); };
  for (std::size_t place = 0; place < attitudes.size(); ++place) {
    if (std::isnan(error_deg(place))) continue;
    const auto x = static_cast<double>(place);
    const bool joined = place > 0 && attitudes[place - 1].mode == attitudes[place].mode &&
                        !std::isnan(error_deg(place - 1));
    if (joined) chart.line(x - 1.0, error_deg(place - 1), x, error_deg(place), colour, 1);
    chart.dot(x, error_deg(place), colour);
  }
}

void draw_sigmas(Chart& chart, const std::vector<SweepAttitude>& attitudes) {
  for (std::size_t place = 0; place < attitudes.size(); ++place) {
    const SweepAttitude& attitude = attitudes[place];
    const double error_deg = deg_from_rad(attitude.with_rad);
    const double sigma_deg = deg_from_rad(attitude.sigma_rad);
    if (std::isnan(error_deg) || std::isnan(sigma_deg)) continue;
    const auto x = static_cast<double>(place);
    chart.line(x, error_deg - sigma_deg, x, error_deg + sigma_deg, kSkyBlue, 3);
  }
}

std::vector<double> errors_deg(const std::vector<SweepAttitude>& attitudes, Error error) {
  std::vector<double> errors;
  errors.reserve(attitudes.size());
  for (const SweepAttitude& attitude : attitudes) errors.push_back(deg_from_rad(attitude.*error));
  return errors;
}

std::vector<double> ends_of_sigmas_deg(const std::vector<SweepAttitude>& attitudes) {
  std::vector<double> ends;
  for (const SweepAttitude& attitude : attitudes) {
    ends.push_back(deg_from_rad(attitude.with_rad - attitude.sigma_rad));
    ends.push_back(deg_from_rad(attitude.with_rad + attitude.sigma_rad));
  }
  return ends;
}

}  // namespace

Outcome write_sweeps_chart(const std::string& path, const std::string& title,
                           const std::vector<SweepAttitude>& attitudes) {
  const std::vector<SweepAttitude> sweeps = sorted_by_mode(attitudes);
  std::vector<double> both = errors_deg(sweeps, &SweepAttitude::without_rad);
  const std::vector<double> with = errors_deg(sweeps, &SweepAttitude::with_rad);
  both.insert(both.end(), with.begin(), with.end());
  const std::vector<double> with_sigmas = ends_of_sigmas_deg(sweeps);
  const Span across{-0.6, static_cast<double>(sweeps.size()) - 0.4};

  std::vector<LegendEntry> legend{{kVermillion, "without correction"}, {kBlue, "with correction"}};
  const auto refused = [](const SweepAttitude& sweep) { return !sweep.corrected; };
  if (std::any_of(sweeps.begin(), sweeps.end(), refused))
    legend.push_back({kGrey, "cross: no attitude, not corrected"});
  Paper paper(kWidth, 800);
  begin(paper, title, legend);
  Chart whole(paper, {kLeft, 120, kWidth - kLeft - 40, 260}, across, span_of_errors(both, 0.5));
  whole.draw_axes("", "phi_error, deg");
  whole.line(across.lowest, 0.0, across.highest, 0.0, kGrey, 1);
  draw_errors(whole, sweeps, &SweepAttitude::without_rad, kVermillion);
  draw_errors(whole, sweeps, &SweepAttitude::with_rad, kBlue);
  for (std::size_t place = 0; place < sweeps.size(); ++place)
    if (!sweeps[place].corrected) whole.cross(static_cast<double>(place), 0.0, kGrey);
  draw_mode_segments(whole, sweeps);

  Chart close(paper, {kLeft, 460, kWidth - kLeft - 40, 260}, across,
              span_of_errors(with_sigmas, 0.1));
  close.draw_axes("", "phi_error with correction alone, deg; the bars are the sigma that was said");
  close.line(across.lowest, 0.0, across.highest, 0.0, kGrey, 1);
  draw_sigmas(close, sweeps);
  draw_errors(close, sweeps, &SweepAttitude::with_rad, kBlue);
  draw_mode_segments(close, sweeps);
  paper.write(std::string("each dot is a sweep; ") + kSign, {kLeft, 780}, 17, kGrey);
  return paper.save(path);
}

namespace {

void draw_extent(Chart& chart, double x, const AngleStatistics& errors, const Colour& colour) {
  if (errors.count == 0) return;
  const double lowest = deg_from_rad(errors.lowest_rad), highest = deg_from_rad(errors.highest_rad);
  const double mean = deg_from_rad(errors.mean_rad);
  chart.line(x, lowest, x, highest, colour, 6);
  for (const double end : {lowest, highest}) chart.line(x - 0.08, end, x + 0.08, end, colour, 3);
  chart.dot(x, mean, colour, 8);
  chart.dot(x, mean, kWhite, 4);
}

void name_modes(Chart& chart, const std::vector<ModeEvaluation>& modes) {
  for (std::size_t place = 0; place < modes.size(); ++place) {
    const std::string words =
        mode_name(modes[place].mode) + " (" + std::to_string(modes[place].sweeps) + ")";
    const cv::Point below(chart.at(static_cast<double>(place), 0.0).x, chart.area().br().y + 20);
    chart.paper().write_centred(words, below, 16, kBlack);
  }
}

std::vector<double> extremes_deg(const std::vector<ModeEvaluation>& modes, bool without) {
  std::vector<double> extremes;
  for (const ModeEvaluation& mode : modes) {
    extremes.push_back(deg_from_rad(mode.with.lowest_rad));
    extremes.push_back(deg_from_rad(mode.with.highest_rad));
    if (!without) continue;
    extremes.push_back(deg_from_rad(mode.without.lowest_rad));
    extremes.push_back(deg_from_rad(mode.without.highest_rad));
  }
  return extremes;
}

}  // namespace

Outcome write_modes_chart(const std::string& path, const std::string& title,
                          const std::vector<ModeEvaluation>& modes) {
  Paper paper(kWidth, 800);
  begin(paper, title, {{kVermillion, "without correction"}, {kBlue, "with correction"}});
  const Span across{-0.6, static_cast<double>(modes.size()) - 0.4};
  Chart whole(paper, {kLeft, 120, kWidth - kLeft - 40, 260}, across,
              span_of_errors(extremes_deg(modes, true), 0.5));
  whole.draw_axes("", "phi_error, deg: from least to largest, the ring is the mean");
  whole.line(across.lowest, 0.0, across.highest, 0.0, kGrey, 1);
  Chart close(paper, {kLeft, 460, kWidth - kLeft - 40, 260}, across,
              span_of_errors(extremes_deg(modes, false), 0.1));
  close.draw_axes("", "the same with correction alone, deg");
  close.line(across.lowest, 0.0, across.highest, 0.0, kGrey, 1);
  for (std::size_t place = 0; place < modes.size(); ++place) {
    const auto x = static_cast<double>(place);
    draw_extent(whole, x - 0.12, modes[place].without, kVermillion);
    draw_extent(whole, x + 0.12, modes[place].with, kBlue);
    draw_extent(close, x, modes[place].with, kBlue);
  }
  name_modes(whole, modes);
  name_modes(close, modes);
  paper.write(std::string("in brackets: how many sweeps; ") + kSign, {kLeft, 780}, 17, kGrey);
  return paper.save(path);
}

namespace {

constexpr int kPanelsARow = 3;
constexpr int kPanelHeight = 340;
constexpr double kShown_mm = 200.0;

double map_error_mm(double distance_m, double phi_error_rad) {
  return mm_from_m(map_error_m(distance_m, phi_error_rad));
}

// The wedge between two errors, from the lidar out to its reach.
void draw_wedge(Chart& chart, const AngleStatistics& errors, const Colour& pale,
                const Colour& colour) {
  if (errors.count == 0) return;
  const double lowest_mm = map_error_mm(kMapReach_m, errors.lowest_rad);
  const double highest_mm = map_error_mm(kMapReach_m, errors.highest_rad);
  chart.area_between(kMapReach_m, lowest_mm, kMapReach_m, highest_mm, pale);
  chart.line(0.0, 0.0, kMapReach_m, lowest_mm, colour, 2);
  chart.line(0.0, 0.0, kMapReach_m, highest_mm, colour, 2);
}

void draw_kept(Chart& chart, const AngleStatistics& errors) {
  if (errors.count == 0) return;
  const double kept_m = kept_up_to_m(errors.largest_rad());
  const bool below = std::abs(errors.lowest_rad) > std::abs(errors.highest_rad);
  const double worst_rad = below ? errors.lowest_rad : errors.highest_rad;
  const double reached_mm = map_error_mm(kept_m, worst_rad);
  chart.dashed(kept_m, -0.8 * kShown_mm, kept_m, reached_mm, kBlack, 1);
  chart.dot(kept_m, reached_mm, kBlack, 5);
  const std::string words =
      "kept up to " + with_decimals(kept_m, kept_m < kMapReach_m ? 2 : 0) + " m";
  const int half = chart.paper().width_of(words, 16) / 2;
  const cv::Rect& area = chart.area();
  const int middle = std::clamp(chart.at(kept_m, 0.0).x, area.x + half + 6, area.br().x - half - 6);
  chart.paper().write_centred(words, {middle, area.br().y - 10}, 16, kBlack);
}

void draw_map_panel(Paper& paper, const cv::Rect& area, const ModeEvaluation& mode) {
  Chart chart(paper, area, {0.0, kMapReach_m}, {-kShown_mm, kShown_mm});
  const double band_mm = mm_from_m(kMapBand_m);
  chart.band(-band_mm, band_mm, kPaleGrey);
  chart.draw_axes("distance, m", "E_map, mm: " + mode_name(mode.mode));
  draw_wedge(chart, mode.without, kPaleVermillion, kVermillion);
  draw_wedge(chart, mode.with, kPaleBlue, kBlue);
  chart.line(0.0, 0.0, kMapReach_m, map_error_mm(kMapReach_m, mode.with.mean_rad), kBlue, 1);
  for (const double bound_mm : {-band_mm, band_mm})
    chart.dashed(0.0, bound_mm, kMapReach_m, bound_mm, kGrey, 1);
  draw_kept(chart, mode.with);
}

}  // namespace

Outcome write_map_error_chart(const std::string& path, const std::string& title,
                              const std::vector<ModeEvaluation>& modes) {
  const int count = static_cast<int>(modes.size());
  const int rows = std::max(1, (count + kPanelsARow - 1) / kPanelsARow);
  const int columns = std::clamp(count, 1, kPanelsARow);
  const int panel_width = (kWidth - 20) / std::max(columns, 2);
  Paper paper(kWidth, 100 + rows * kPanelHeight + 40);
  begin(paper, title,
        {{kVermillion, "without correction, least to largest"},
         {kBlue, "with correction"},
         {kGrey, "+-50 mm"}});
  for (int panel = 0; panel < count; ++panel) {
    const int left = kLeft - 16 + panel % kPanelsARow * panel_width;
    const int top = 120 + panel / kPanelsARow * kPanelHeight;
    draw_map_panel(paper, {left, top, panel_width - 90, kPanelHeight - 100},
                   modes[static_cast<std::size_t>(panel)]);
  }
  paper.write("E_map = distance * tan(phi_error); where a wedge leaves the panel it is cut off",
              {kLeft, 100 + rows * kPanelHeight + 24}, 17, kGrey);
  return paper.save(path);
}

}  // namespace swivel
