// The verbs of `swivel`, a file each. add_... tells the command line of a verb; `chosen` becomes
// what main runs.
#pragma once

#include <CLI/App.hpp>
#include <functional>

namespace swivel {

class StopSignal;

using Verb = std::function<int()>;

void add_up(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_status(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_scan(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_calibrate(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_record(CLI::App& app, StopSignal& stop, Verb& chosen);  // and capture
void add_replay(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_topic_verbs(CLI::App& app, StopSignal& stop, Verb& chosen);  // ls, hz, bw, delay, echo
void add_export(CLI::App& app, Verb& chosen);
void add_mcap_verbs(CLI::App& app, Verb& chosen);  // info, check, recover, slice
void add_process(CLI::App& app, Verb& chosen);
void add_map(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_report(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_view(CLI::App& app, Verb& chosen);
void add_doctor(CLI::App& app, Verb& chosen);
void add_discovery_server(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_keys(CLI::App& app, Verb& chosen);
void add_demo(CLI::App& app, StopSignal& stop, Verb& chosen);

}  // namespace swivel
