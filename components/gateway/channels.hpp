// The topics that Foxglove gets, as CDR with their schemas.
#pragma once

#include <string>
#include <vector>

#include "components/gateway/foxglove.hpp"

namespace swivel {

// The ids of the channels, and their places in the list.
enum ChannelId : std::uint32_t {
  kScanLineChannel,
  kAxisChannel,
  kSweepChannel,
  kAttitudeChannel,
  kCalibrationChannel,
  kHealthChannel,
  kCloudChannel,
  kChannelCount
};

std::vector<FoxgloveChannel> foxglove_channels(const std::string& rig);

}  // namespace swivel
