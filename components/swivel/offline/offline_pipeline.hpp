// A recording through the same stages as a live rig, without DDS, as fast as the machine goes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "components/cloud_assembler/assembler.hpp"
#include "components/common/rig_file.hpp"
#include "components/recording/recording.hpp"
#include "components/swivel/offline/processed_sweep.hpp"

namespace swivel {

// The recording, or an ExitError that says what to do.
Recording open_recording(const std::string& path);

// The rig file asked for. Without one the rig that the recording suggests, with what the
// recording itself says of its plate. Throws ConfigurationError or ExitError.
RigFile rig_of(const RecordingFacts& facts, const std::string& path, const std::string& rig_file);

using OnCalibration = std::function<void(const msg::Calibration&)>;

// All of it through the assembler, to its end. Throws ExitError where the recording is damaged.
void play(Recording& recording, Assembler& assembler, const OnCalibration& on_calibration);

// For what looks for a calibration: those in the recording do not count.
inline void pass_over(const msg::Calibration&) {}

// Calls on_sweep for each sweep in order. Without a calibration those in the recording hold, each
// from when it was told. Throws ExitError where the recording is damaged.
void run_offline(Recording& recording, const RigFile& rig,
                 const std::optional<msg::Calibration>& calibration,
                 const std::function<void(const ProcessedSweep&)>& on_sweep);

// Likewise, with the rig as it is drawn.
void run_offline_as_drawn(Recording& recording, const RigFile& rig,
                          const std::function<void(const ProcessedSweep&)>& on_sweep);

}  // namespace swivel
