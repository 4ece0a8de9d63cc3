// The sums over a whole MCAP file, which reading its messages does not need.
#pragma once

#include <string>

#include "hardware/result.hpp"

namespace swivel {

// Fails with what is wrong: no end, a wrong sum over the data, a wrong one over the summary.
Outcome check_file_sums(const std::string& path);

}  // namespace swivel
