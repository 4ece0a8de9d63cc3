// A controller on a pty, which stands in for its USB serial port.
#pragma once

#include <poll.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "hardware/sim/file_descriptor.hpp"
#include "hardware/sim/serial_device.hpp"

namespace swivel::sim {

class GrblPort {
 public:
  // `link` is a symbolic link to be made to the pty and removed at the end; empty for none.
  // Throws std::system_error. `peer` must outlive the port.
  GrblPort(SerialDevice& peer, const std::string& link);
  ~GrblPort();
  GrblPort(const GrblPort&) = delete;
  GrblPort& operator=(const GrblPort&) = delete;

  const std::string& path() const { return path_; }  // of the pty itself
  void add_to(std::vector<pollfd>& waits) const;
  std::int64_t next_event_ns(std::int64_t now_ns) const;
  void serve(std::int64_t now_ns);  // never blocks

  // Faults from now on.
  void unplug(double duration_s, std::int64_t now_ns);  // the controller keeps its power
  void silence(double duration_s, std::int64_t now_ns);
  void delay_answers(double delay_s);

 private:
  struct Answer {
    std::string text;
    std::int64_t due_ns;
  };

  void plug_in();
  void take_answers(std::int64_t now_ns);
  void make_link();
  void watch_openings();
  void note_openings(std::int64_t now_ns);
  void read_client(std::int64_t now_ns);
  void write_client();

  SerialDevice* peer_;
  std::string link_;
  std::string path_;
  FileDescriptor pty_;
  FileDescriptor openings_;
  int clients_ = 0;  // that have it open
  std::string outgoing_;
  std::deque<Answer> held_;
  std::int64_t answer_delay_ns_ = 0;
  std::int64_t silent_until_ns_ = 0;
  std::int64_t plugged_in_at_ns_ = 0;  // once unplugged; 0: it is in
};

}  // namespace swivel::sim
