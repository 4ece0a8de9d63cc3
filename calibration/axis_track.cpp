#include "calibration/axis_track.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/units.hpp"

namespace swivel {
namespace {

// From earlier to later, whatever the two are: the difference of two int64 may need 64 bits.
double elapsed_ns(std::int64_t earlier_ns, std::int64_t later_ns) {
  return static_cast<double>(static_cast<std::uint64_t>(later_ns) -
                             static_cast<std::uint64_t>(earlier_ns));
}

double between(const AxisSample& before, const AxisSample& after, std::int64_t time_ns) {
  const double part =
      elapsed_ns(before.time_ns, time_ns) / elapsed_ns(before.time_ns, after.time_ns);
  return before.angle_rad + part * (after.angle_rad - before.angle_rad);
}

}  // namespace

AxisAdded AxisTrack::add(const AxisSample& sample) {
  if (!std::isfinite(sample.angle_rad)) return AxisAdded::kNotFinite;
  if (!samples_.empty() && sample.time_ns == samples_.back().time_ns) return AxisAdded::kSameTime;
  if (!samples_.empty() && sample.time_ns < samples_.back().time_ns) return AxisAdded::kBackwards;
  samples_.push_back(sample);
  return AxisAdded::kAdded;
}

AxisTrack::Samples::const_iterator AxisTrack::first_at_or_after(std::int64_t time_ns) const {
  return std::lower_bound(
      samples_.begin(), samples_.end(), time_ns,
      [](const AxisSample& sample, std::int64_t time) { return sample.time_ns < time; });
}

std::optional<double> AxisTrack::angle_at(std::int64_t time_ns) const {
  if (!covers(time_ns, time_ns)) return std::nullopt;
  const auto after = first_at_or_after(time_ns);
  if (after->time_ns == time_ns) return after->angle_rad;
  return between(*std::prev(after), *after, time_ns);
}

bool AxisTrack::covers(std::int64_t start_ns, std::int64_t end_ns) const {
  return !samples_.empty() && start_ns <= end_ns && samples_.front().time_ns <= start_ns &&
         end_ns <= samples_.back().time_ns;
}

std::optional<AxisSegment> AxisTrack::segment_over(std::int64_t start_ns,
                                                   std::int64_t end_ns) const {
  const auto start_rad = angle_at(start_ns);
  const auto end_rad = angle_at(end_ns);
  if (!start_rad || !end_rad || start_ns >= end_ns) return std::nullopt;
  const AxisSample start{start_ns, *start_rad};
  const AxisSample end{end_ns, *end_rad};
  const auto stop = first_at_or_after(end_ns);
  for (auto sample = first_at_or_after(start_ns); sample != stop; ++sample) {
    const double straight_rad = between(start, end, sample->time_ns);
    if (!(std::abs(sample->angle_rad - straight_rad) <= kStraightRad)) return std::nullopt;
  }
  const double duration_s = s_from_ns(elapsed_ns(start_ns, end_ns));
  return AxisSegment{*start_rad, (*end_rad - *start_rad) / duration_s};
}

void AxisTrack::forget_before(std::int64_t time_ns) {
  const auto keep = first_at_or_after(time_ns);
  const bool between_samples = keep != samples_.end() && keep->time_ns != time_ns;
  const auto first = between_samples && keep != samples_.begin() ? std::prev(keep) : keep;
  if (first == samples_.end() && !samples_.empty()) {  // the last one says where time has got to
    samples_.erase(samples_.begin(), std::prev(samples_.end()));
    return;
  }
  samples_.erase(samples_.begin(), first);
}

}  // namespace swivel
