#include "components/swivel/pictures/chart.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace swivel {
namespace {

constexpr int kLetters = 16;

// 1, 2 or 5 times a power of ten: a grid of at most so many lines.
double round_step(const Span& span, int most_lines) {
  const double least = (span.highest - span.lowest) / most_lines;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10.0 * power;
}

int decimals_for(double step) {
  return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
}

template <class Draw>
void for_each_tick(const Span& span, double step, Draw draw) {
  const auto last = static_cast<long>(std::floor(span.highest / step + 1e-9));
  for (auto tick = static_cast<long>(std::ceil(span.lowest / step - 1e-9)); tick <= last; ++tick) {
    const double value = static_cast<double>(tick) * step;
    draw(value, with_decimals(value, decimals_for(step)));
  }
}

}  // namespace

Span span_of(double lowest, double highest, double least) {
  Span span{std::fmin(0.0, lowest), std::fmax(0.0, highest)};
  const double room =
      std::max(0.12 * (span.highest - span.lowest), 0.5 * (least - (span.highest - span.lowest)));
  return {span.lowest - room, span.highest + room};
}

Chart::Chart(Paper& paper, const cv::Rect& area, Span x, Span y)
    : paper_(paper), area_(area), x_(x), y_(y) {}

void Chart::draw_axes(const std::string& x_name, const std::string& y_name) {
  for_each_tick(y_, round_step(y_, area_.height / 40 + 1), [&](double y, const auto& label) {
    const int row = at(x_.lowest, y).y;
    cv::line(paper_.pixels(), {area_.x, row}, {area_.br().x, row}, kFaint);
    paper_.write(label, {area_.x - 8 - paper_.width_of(label, kLetters), row + 6}, kLetters, kGrey);
  });
  if (!x_name.empty()) {
    for_each_tick(x_, round_step(x_, area_.width / 70 + 1), [&](double x, const auto& label) {
      const int column = at(x, y_.lowest).x;
      cv::line(paper_.pixels(), {column, area_.y}, {column, area_.br().y}, kFaint);
      paper_.write_centred(label, {column, area_.br().y + 20}, kLetters, kGrey);
    });
    paper_.write_centred(x_name, {area_.x + area_.width / 2, area_.br().y + 44}, kLetters, kBlack);
  }
  cv::rectangle(paper_.pixels(), area_, kGrey);
  paper_.write(y_name, {area_.x, area_.y - 10}, kLetters, kBlack);
}

cv::Point Chart::at(double x, double y) const {
  const auto place = [](double value, const Span& span, int pixels) {
    const double part = (value - span.lowest) / (span.highest - span.lowest);
    return static_cast<int>(std::lround(std::clamp(part, -10.0, 10.0) * pixels));
  };
  return {area_.x + place(x, x_, area_.width), area_.br().y - place(y, y_, area_.height)};
}

bool Chart::holds(double x, double y) const {
  return x >= x_.lowest && x <= x_.highest && y >= y_.lowest && y <= y_.highest;
}

bool Chart::clip(cv::Point& start, cv::Point& end) const {
  return cv::clipLine(area_, start, end);
}

void Chart::line(double x0, double y0, double x1, double y1, const Colour& colour, int thickness) {
  cv::Point start = at(x0, y0), end = at(x1, y1);
  if (clip(start, end)) cv::line(paper_.pixels(), start, end, colour, thickness, cv::LINE_AA);
}

void Chart::dashed(double x0, double y0, double x1, double y1, const Colour& colour,
                   int thickness) {
  const cv::Point whole = at(x1, y1) - at(x0, y0);
  const int dashes = std::max(1, static_cast<int>(std::hypot(whole.x, whole.y) / 16.0));
  const double step_x = (x1 - x0) / dashes, step_y = (y1 - y0) / dashes;
  for (int dash = 0; dash < dashes; ++dash) {
    line(x0 + dash * step_x, y0 + dash * step_y, x0 + (dash + 0.6) * step_x,
         y0 + (dash + 0.6) * step_y, colour, thickness);
  }
}

void Chart::band(double y0, double y1, const Colour& colour) {
  const int top = std::clamp(at(0.0, y1).y, area_.y, area_.br().y);
  const int bottom = std::clamp(at(0.0, y0).y, area_.y, area_.br().y);
  cv::rectangle(paper_.pixels(), cv::Rect(area_.x, top, area_.width, bottom - top), colour,
                cv::FILLED);
}

void Chart::area_between(double x0, double y0, double x1, double y1, const Colour& colour) {
  cv::Mat part = paper_.pixels()(area_);
  const std::vector<cv::Point> corners{at(0.0, 0.0) - area_.tl(), at(x0, y0) - area_.tl(),
                                       at(x1, y1) - area_.tl()};
  cv::fillConvexPoly(part, corners, colour, cv::LINE_AA);
}

void Chart::dot(double x, double y, const Colour& colour, int radius) {
  if (holds(x, y)) cv::circle(paper_.pixels(), at(x, y), radius, colour, cv::FILLED, cv::LINE_AA);
}

void Chart::cross(double x, double y, const Colour& colour) {
  if (!holds(x, y)) return;
  cv::drawMarker(paper_.pixels(), at(x, y), colour, cv::MARKER_TILTED_CROSS, 14, 2, cv::LINE_AA);
}

void Chart::speck(double x, double y, const Colour& colour, int size) {
  if (!holds(x, y)) return;
  const cv::Rect place(at(x, y) - cv::Point(size / 2, size / 2), cv::Size(size, size));
  paper_.pixels()(place & area_) = colour;
}

}  // namespace swivel
