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

// All of it through the assembler, to its end. Throws ExitError where the recording is damaged.
void play(Recording recording, Assembler& assembler);

enum class Readings { kForgotten, kKept };

// Calls on_sweep for each sweep in order. Throws ExitError where the recording is damaged.
void run_offline(Recording recording, const RigFile& rig,
                 const std::optional<msg::Calibration>& calibration,
                 const std::function<void(ProcessedSweep&&)>& on_sweep,
                 Readings readings = Readings::kForgotten);

}  // namespace swivel
