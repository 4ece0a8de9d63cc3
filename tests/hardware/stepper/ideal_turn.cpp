#include <algorithm>
#include <cmath>

#include "tests/hardware/stepper/grbl_double.hpp"

namespace swivel::test {
namespace {

double since_s(std::int64_t time_ns, std::int64_t start_ns) {
  return static_cast<double>(time_ns - start_ns) * 1e-9;
}

std::int64_t later(std::int64_t start_ns, double seconds) {
  return start_ns + static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace

double IdealTurn::length_deg() const {
  return std::abs(to_deg - from_deg);
}

double IdealTurn::peak_deg_s() const {
  return std::min(speed_deg_s, std::sqrt(length_deg() * acceleration_deg_s2));
}

double IdealTurn::run_up_s() const {
  return peak_deg_s() / acceleration_deg_s2;
}

double IdealTurn::duration_s() const {
  if (length_deg() <= 0.0) return 0.0;
  return length_deg() / peak_deg_s() + run_up_s();
}

std::int64_t IdealTurn::steady_start_ns() const {
  return later(start_ns, run_up_s());
}

std::int64_t IdealTurn::steady_end_ns() const {
  return later(start_ns, duration_s() - run_up_s());
}

std::int64_t IdealTurn::end_ns() const {
  std::int64_t end = later(start_ns, duration_s());
  if (cancelled_ns != 0)
    end = std::min(end, later(cancelled_ns, speed_at(cancelled_ns) / acceleration_deg_s2));
  return cut_ns != 0 ? std::min(end, cut_ns) : end;
}

double IdealTurn::speed_at(std::int64_t time_ns) const {
  const double after_start = std::max(0.0, since_s(time_ns, start_ns));
  const double before_end = std::max(0.0, duration_s() - after_start);
  const double planned =
      std::min({peak_deg_s(), acceleration_deg_s2 * after_start, acceleration_deg_s2 * before_end});
  if (cancelled_ns == 0 || time_ns <= cancelled_ns) return planned;
  const double braked = acceleration_deg_s2 * since_s(time_ns, cancelled_ns);
  return std::max(0.0, speed_at(cancelled_ns) - braked);
}

double IdealTurn::angle_deg(std::int64_t time_ns) const {
  const double direction = to_deg < from_deg ? -1.0 : 1.0;
  if (cut_ns != 0) time_ns = std::min(time_ns, cut_ns);
  if (cancelled_ns != 0 && time_ns > cancelled_ns) {
    IdealTurn uncancelled = *this;
    uncancelled.cancelled_ns = 0;
    const double speed = speed_at(cancelled_ns);
    const double braking_s = std::min(since_s(time_ns, cancelled_ns), speed / acceleration_deg_s2);
    return uncancelled.angle_deg(cancelled_ns) +
           direction * (speed * braking_s - 0.5 * acceleration_deg_s2 * braking_s * braking_s);
  }
  const double whole_s = duration_s();
  const double now_s = std::clamp(since_s(time_ns, start_ns), 0.0, whole_s);
  const double up_s = std::min(now_s, run_up_s());
  const double down_s = std::max(0.0, now_s - (whole_s - run_up_s()));
  const double steady_s = now_s - up_s - down_s;
  const double travelled = 0.5 * acceleration_deg_s2 * up_s * up_s + peak_deg_s() * steady_s +
                           peak_deg_s() * down_s - 0.5 * acceleration_deg_s2 * down_s * down_s;
  return from_deg + direction * travelled;
}

}  // namespace swivel::test
