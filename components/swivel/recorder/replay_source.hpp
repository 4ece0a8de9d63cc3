// What a player plays: the messages of a recording of either kind, in the order of their time.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/any_topic.hpp"
#include "components/recording/recording.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct ReplayMessage {
  std::int64_t time_ns = 0;
  const AnyTopic* topic = nullptr;  // of all_topics()
  std::string cdr;
};

// The next message; nothing at the end. A failure tells what is wrong with the recording.
using ReplaySource = std::function<Result<std::optional<ReplayMessage>>()>;

// A part of a recording, in seconds from its first message.
struct TimeWindow {
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
};

ReplaySource play_case(Recording recording);

// topics: by full name. None: what the hardware sent, and the calibration; not what the stages made
// of it, which they make again.
ReplaySource play_mcap(const std::string& path, const std::vector<std::string>& topics,
                       const TimeWindow& window);

}  // namespace swivel
