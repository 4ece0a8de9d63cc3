// A recording through the same stages as a live rig, without DDS, as fast as the machine goes.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "components/common/rig_file.hpp"
#include "components/recording/recording.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct ProcessedSweep {
  std::size_t index = 0;  // counted from 0
  msg::Sweep sweep;       // as assembled
  msg::Attitude attitude;
  OrganisedCloud raw;    // in frame O'; of a rig that measures its axis in the base
  OrganisedCloud cloud;  // in the base if the attitude's verdict says so, else as raw
};

// The recording, or an ExitError that says what to do.
Recording open_recording(const std::string& path);

// The rig file asked for. Without one the rig that the recording suggests, with what the
// recording itself says of its plate. Throws ConfigurationError or ExitError.
RigFile rig_of(const RecordingFacts& facts, const std::string& path, const std::string& rig_file);

// Calls on_sweep for each sweep in order. Throws ExitError where the recording is damaged.
void run_offline(Recording recording, const RigFile& rig,
                 const std::optional<msg::Calibration>& calibration,
                 const std::function<void(ProcessedSweep&&)>& on_sweep);

}  // namespace swivel
