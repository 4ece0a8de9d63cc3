// What the verbs have in common that make something of a recording, or of a live rig.
#pragma once

#include <CLI/App.hpp>

#include "components/common/program.hpp"
#include "components/swivel/offline/recorded_run.hpp"

namespace swivel {

inline constexpr const char* kLive = "live";  // in place of a recording

// --rig is not among them: a live rig's comes with the common options.
void add_source_options(CLI::App& verb, RecordedRunOptions& options, bool live_too);

// Empty where none was asked for: then that counts which suits the recording.
std::string asked_rig_file(const CLI::App& verb, const CommonOptions& common);

// The rig, and the log of a verb that works on a live one. Throws ExitError where what was asked
// for is a recording's alone, or ConfigurationError.
RigFile begin_live(const CommonOptions& common, const RecordedRunOptions& options);

}  // namespace swivel
