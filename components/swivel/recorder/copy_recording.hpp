// A recording's sound messages, or a part of them, in a new file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/mcap/reader.hpp"
#include "components/swivel/recorder/replay_source.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct Copied {
  std::uint64_t messages = 0;
  McapDamage damage;  // of the file copied from
};

// topics: by full name; none: all.
Result<Copied> copy_recording(const std::string& from, const std::string& to,
                              const TimeWindow& window, const std::vector<std::string>& topics);

}  // namespace swivel
