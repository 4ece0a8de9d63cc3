#include "calibration/two_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr double kLeastOverlapRad = rad_from_deg(20.0);  // of a turn beyond half of one

// Axis angles, from the least to the largest.
struct Turn {
  double lowest_rad = std::numeric_limits<double>::infinity();
  double highest_rad = -std::numeric_limits<double>::infinity();

  void add(double angle_rad) {
    lowest_rad = std::min(lowest_rad, angle_rad);
    highest_rad = std::max(highest_rad, angle_rad);
  }
  bool holds(double angle_rad) const { return angle_rad >= lowest_rad && angle_rad <= highest_rad; }
};

// Up is the first view, down the second.
std::optional<std::vector<View>> views_up_and_down(const std::vector<LineOfReadings>& lines) {
  Turn up;
  Turn down;
  for (const LineOfReadings& line : lines) (line.turning_down ? down : up).add(line.axis_angle_rad);
  std::vector<View> views;
  bool any = false;
  for (const LineOfReadings& line : lines) {
    const bool twice = up.holds(line.axis_angle_rad) && down.holds(line.axis_angle_rad);
    any = any || twice;
    views.push_back(!twice ? View::kOnlyOne : line.turning_down ? View::kSecond : View::kFirst);
  }
  return any ? std::optional(views) : std::nullopt;
}

std::optional<std::vector<View>> halves_of_turn(const std::vector<LineOfReadings>& lines) {
  const auto turned_rad = [&lines](const LineOfReadings& line) {
    return std::abs(line.axis_angle_rad - lines.front().axis_angle_rad);
  };
  double most_rad = 0.0;
  for (const LineOfReadings& line : lines) most_rad = std::max(most_rad, turned_rad(line));
  if (most_rad < kPi + kLeastOverlapRad) return std::nullopt;
  std::vector<View> views;
  for (const LineOfReadings& line : lines) {
    const double rad = turned_rad(line);
    views.push_back(rad >= kPi              ? View::kSecond
                    : rad <= most_rad - kPi ? View::kFirst
                                            : View::kOnlyOne);
  }
  return views;
}

}  // namespace

std::optional<std::vector<View>> views_of_lines(const SweepReadings& readings) {
  const auto& lines = readings.lines;
  if (lines.empty()) return std::nullopt;
  const auto down = [](const LineOfReadings& line) { return line.turning_down; };
  const bool both_ways = std::any_of(lines.begin(), lines.end(), down) &&
                         !std::all_of(lines.begin(), lines.end(), down);
  return both_ways ? views_up_and_down(lines) : halves_of_turn(lines);
}

}  // namespace swivel
