// TCP on this computer only.
#pragma once

#include "hardware/sim/file_descriptor.hpp"

namespace swivel::sim {

struct LoopbackListener {
  FileDescriptor descriptor;
  int port = 0;
};

// port 0: any free one. Throws std::system_error.
LoopbackListener listen_on_loopback(int port);

// The next client, which does not block; closed if nobody waits.
FileDescriptor accept_next(const FileDescriptor& listener);

}  // namespace swivel::sim
