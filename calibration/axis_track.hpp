// The axis angle over time: samples, and straight lines between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace swivel {

struct AxisSample {
  std::int64_t time_ns = 0;
  double angle_rad = 0.0;
};

// A stretch of the track that is straight: angle = start + rate * (time - start time).
struct AxisSegment {
  double start_angle_rad = 0.0;
  double rate_rad_s = 0.0;
};

enum class AxisAdded { kAdded, kSameTime, kBackwards, kNotFinite };

class AxisTrack {
 public:
  // Only a later time than the last is taken; what is refused leaves the track as it was.
  [[nodiscard]] AxisAdded add(const AxisSample& sample);

  // None outside of the samples: the track does not extrapolate.
  std::optional<double> angle_at(std::int64_t time_ns) const;

  bool covers(std::int64_t start_ns, std::int64_t end_ns) const;

  // The stretch [start_ns, end_ns], when the track covers it and no sample inside it is further
  // than kStraightRad from the line between its ends; else none.
  std::optional<AxisSegment> segment_over(std::int64_t start_ns, std::int64_t end_ns) const;

  // Forgets what angles at time_ns and later do not need.
  void forget_before(std::int64_t time_ns);

  std::size_t size() const { return samples_.size(); }

  // 0.3 micrometres at 30 m.
  static constexpr double kStraightRad = 1e-8;

 private:
  using Samples = std::deque<AxisSample>;
  Samples::const_iterator first_at_or_after(std::int64_t time_ns) const;

  Samples samples_;  // in order of time
};

}  // namespace swivel
