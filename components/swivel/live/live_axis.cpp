#include "components/swivel/live/live_axis.hpp"

#include "calibration/units.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kKept_ns = 120'000'000'000;

}  // namespace

LiveAxis::LiveAxis(Participant& participant) {
  participant.subscribe<msg::Axis>(kAxisTopic, [this](const msg::Axis& axis) {
    const std::lock_guard lock(mutex_);
    for (const msg::AxisSample& sample : axis.samples()) {
      const AxisSample angle{sample.time_ns(), rad_from_deg(sample.angle_deg())};
      if (track_.add(angle) == AxisAdded::kAdded) track_.forget_before(sample.time_ns() - kKept_ns);
    }
  });
}

std::optional<double> LiveAxis::angle_deg(std::int64_t time_ns) const {
  const std::lock_guard lock(mutex_);
  const auto angle_rad = track_.angle_at(time_ns);
  return angle_rad ? std::optional(deg_from_rad(*angle_rad)) : std::nullopt;
}

}  // namespace swivel
