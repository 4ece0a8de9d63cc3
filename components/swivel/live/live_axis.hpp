// The axis angle as it comes over DDS, to be asked for any instant of late. Thread-safe.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "calibration/axis_track.hpp"
#include "components/dds/participant.hpp"

namespace swivel {

class LiveAxis {
 public:
  // Subscribes: before participant.start().
  explicit LiveAxis(Participant& participant);

  std::optional<double> angle_deg(std::int64_t time_ns) const;

 private:
  mutable std::mutex mutex_;
  AxisTrack track_;
};

}  // namespace swivel
