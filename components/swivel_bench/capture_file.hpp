// What swivel capture wrote, as conversations that can be had again.
#pragma once

#include <string>
#include <vector>

#include "hardware/result.hpp"
#include "hardware/sim/capture_bench.hpp"

namespace swivel {

struct Capture {
  std::vector<sim::Conversation> lidar;  // a connection each, in order of time
  std::vector<sim::Conversation> stepper;
  std::vector<std::string> remarks;  // what is in it, and what is missing, in words
};

// Fails where nothing of a wire is in it.
Result<Capture> load_capture(const std::string& path);

}  // namespace swivel
