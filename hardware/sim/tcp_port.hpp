// A device on TCP, on this computer only, one client at a time. Nothing here blocks.
#pragma once

#include <poll.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/sim/captured_device.hpp"
#include "hardware/sim/loopback_listener.hpp"

namespace swivel::sim {

class TcpPort {
 public:
  // Throws std::system_error when the port cannot be had. `device` must outlive this.
  TcpPort(CapturedDevice& device, int port);

  int port() const { return listener_.port; }
  void add_to(std::vector<pollfd>& waits) const;
  std::int64_t next_event_ns(std::int64_t now_ns) const;  // when serve() is due by itself
  void serve(std::int64_t now_ns);

 private:
  void read_client(std::int64_t now_ns);
  void write_client();

  CapturedDevice* device_;
  LoopbackListener listener_;
  FileDescriptor client_;
  std::string outgoing_;
  bool close_when_sent_ = false;
};

}  // namespace swivel::sim
