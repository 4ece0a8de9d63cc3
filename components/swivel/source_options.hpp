// What the verbs have in common that make something of a recording, or of a live rig.
#pragma once

#include <CLI/App.hpp>

#include "components/swivel/offline/recorded_run.hpp"

namespace swivel {

inline constexpr const char* kLive = "live";  // in place of a recording

// --rig is not among them: a live rig's comes with the common options.
void add_source_options(CLI::App& verb, RecordedRunOptions& options, bool live_too);

}  // namespace swivel
