// Which messages of a recording lie in a part of it.
#pragma once

#include <optional>

#include "components/dds/any_topic.hpp"
#include "components/swivel/recorder/replay_source.hpp"

namespace swivel {

class TimeFilter {
 public:
  explicit TimeFilter(const TimeWindow& window) : window_(window) {}

  // Messages are asked for in their order. A calibration from before stands in the window too.
  bool takes(const std::string& topic, std::int64_t time_ns) {
    const double now_s = static_cast<double>(time_ns) * 1e-9;
    const double first_s = first_s_.value_or(now_s);
    first_s_ = first_s;
    const double time_s = now_s - first_s;
    if (time_s >= window_.from_s) return time_s < window_.to_s;
    const auto known = find_topic(topic);
    return known && known->topic.is(kCalibrationTopic);
  }

 private:
  TimeWindow window_;
  std::optional<double> first_s_;
};

}  // namespace swivel
