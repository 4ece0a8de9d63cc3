// An area of a paper with two scales: where a value comes to lie, and the axes that say so.
#pragma once

#include <string>

#include "components/swivel/pictures/paper.hpp"

namespace swivel {

struct Span {
  double lowest = 0.0;
  double highest = 1.0;
};

// What holds the values, zero in it, with some room; a span of `least` at least.
Span span_of(double lowest, double highest, double least);

class Chart {
 public:
  // Draws nothing yet. The labels of the axes stand outside of the area: 70 pixels to the left,
  // 50 below, 14 above.
  Chart(Paper& paper, const cv::Rect& area, Span x, Span y);

  // Grid, numbers, what the axes are (with unit). x_name empty: no numbers along X.
  void draw_axes(const std::string& x_name, const std::string& y_name);

  cv::Point at(double x, double y) const;
  bool holds(double x, double y) const;

  void line(double x0, double y0, double x1, double y1, const Colour& colour, int thickness = 2);
  void dashed(double x0, double y0, double x1, double y1, const Colour& colour, int thickness = 2);
  void band(double y0, double y1, const Colour& colour);  // across the whole area
  void area_between(double x0, double y0, double x1, double y1, const Colour& colour);  // from 0, 0
  void dot(double x, double y, const Colour& colour, int radius = 5);
  void cross(double x, double y, const Colour& colour);
  void speck(double x, double y, const Colour& colour, int size = 2);  // one of many

  const cv::Rect& area() const { return area_; }
  Paper& paper() { return paper_; }

 private:
  bool clip(cv::Point& start, cv::Point& end) const;

  Paper& paper_;
  cv::Rect area_;
  Span x_;
  Span y_;
};

}  // namespace swivel
