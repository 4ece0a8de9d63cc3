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
void add_replay(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_process(CLI::App& app, Verb& chosen);
void add_report(CLI::App& app, StopSignal& stop, Verb& chosen);
void add_view(CLI::App& app, Verb& chosen);
void add_doctor(CLI::App& app, Verb& chosen);
void add_demo(CLI::App& app, StopSignal& stop, Verb& chosen);

}  // namespace swivel
