// The verbs of `swivel`, a file each. add_... tells the command line of a verb; `chosen` becomes
// what main runs.
#pragma once

#include <CLI/App.hpp>
#include <functional>

namespace swivel {

using Verb = std::function<int()>;

void add_process(CLI::App& app, Verb& chosen);
void add_calibrate(CLI::App& app, Verb& chosen);

}  // namespace swivel
