// The bench's world in a file (config/benches/*.yaml). Every key may be left out: it then has the
// value that the structs in hardware/sim give it. Unknown keys are errors.
#pragma once

#include <string>

#include "hardware/sim/bench.hpp"

namespace swivel {

// Throws ConfigurationError with file and line.
sim::BenchOptions load_bench_file(const std::string& path);

}  // namespace swivel
