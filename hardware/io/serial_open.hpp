// Private to hardware/io.
#pragma once

#include <string>

#include "hardware/result.hpp"

namespace swivel {

// The descriptor, non-blocking, raw, 8N1, of PATH[@BAUD].
Result<int> serial_open(const std::string& path_and_baud);

}  // namespace swivel
