// Private to hardware/io.
#pragma once

#include <string>

#include "hardware/io/wait_ready.hpp"
#include "hardware/result.hpp"

namespace swivel {

// The descriptor, non-blocking, of a connection to HOST:PORT.
Result<int> tcp_connect(const std::string& host_and_port, Deadline deadline, const WakeUp* wake_up);

}  // namespace swivel
