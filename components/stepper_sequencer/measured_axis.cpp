#include "components/stepper_sequencer/measured_axis.hpp"

#include <algorithm>
#include <cmath>

namespace swivel {
namespace {

constexpr std::int64_t kSlack_ns = 200'000;  // a quick answer may take this much more than twice
constexpr std::int64_t kForgets = 50;        // its fiftieth part a report

}  // namespace

std::optional<msg::AxisSample> MeasuredAxis::add(const StepperStatus& report) {
  const std::int64_t trip_ns = report.answered_ns - report.asked_ns;
  const std::int64_t middle_ns = report.asked_ns + trip_ns / 2;
  if (!std::isfinite(report.angle_deg) || trip_ns < 0 || middle_ns <= last_ns_) {
    ++left_out_;
    return std::nullopt;
  }
  quick_ns_ = quick_ns_ == 0 ? trip_ns : std::min(trip_ns, quick_ns_ + quick_ns_ / kForgets + 1);
  const bool quick = trip_ns <= 2 * quick_ns_ + kSlack_ns;
  if (!quick && middle_ns - last_ns_ < kLongestGapNs) {
    ++left_out_;
    return std::nullopt;
  }
  last_ns_ = middle_ns;
  msg::AxisSample sample;
  sample.time_ns(middle_ns);
  sample.angle_deg(report.angle_deg);
  return sample;
}

}  // namespace swivel
