// The controller on a pty, which stands in for its USB serial port.
#pragma once

#include <poll.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/sim/file_descriptor.hpp"
#include "hardware/sim/grbl_peer.hpp"

namespace swivel::sim {

class GrblPort {
 public:
  // `link` is a symbolic link to be made to the pty and removed at the end; empty for none.
  // Throws std::system_error. `peer` must outlive the port.
  GrblPort(GrblPeer& peer, const std::string& link);
  ~GrblPort();
  GrblPort(const GrblPort&) = delete;
  GrblPort& operator=(const GrblPort&) = delete;

  const std::string& path() const { return path_; }  // of the pty itself
  void add_to(std::vector<pollfd>& waits) const;
  std::int64_t next_event_ns(std::int64_t now_ns) const;
  void serve(std::int64_t now_ns);  // never blocks

 private:
  void make_link();
  void watch_openings();
  void note_openings(std::int64_t now_ns);
  void read_client(std::int64_t now_ns);
  void write_client();

  GrblPeer* peer_;
  std::string link_;
  std::string path_;
  FileDescriptor pty_;
  FileDescriptor openings_;
  int clients_ = 0;  // that have it open
  std::string outgoing_;
};

}  // namespace swivel::sim
