// The sensor on TCP, on this computer only. One client at a time: a second one waits until
// the first has left. Served from one loop with poll(2); nothing here blocks.
#pragma once

#include <poll.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hardware/sim/file_descriptor.hpp"
#include "hardware/sim/scip_sensor.hpp"

namespace swivel::sim {

// What a server or a network may do to a client. Each `every` counts scan frames; 0 is never.
struct Misbehaviour {
  bool chop = false;    // single bytes
  int glue_frames = 0;  // this many frames at once
  int stall_every = 0;  // then nothing for stall_s
  double stall_s = 1.0;
  int bad_sum_every = 0;
  int close_every = 0;  // in the middle of the frame
};

// What becomes of the next frames, each kind at its own count; told while the bench runs.
struct SpoiledFrames {
  int dropped = 0;
  int halved = 0;
  int bad_sums = 0;
  int wrong_echoes = 0;
  int refused = 0;  // a status in place of the data
  std::string status;
};

struct ScipServerOptions {
  int port = 0;  // 0: any free one
  double reboot_s = 1.0;
  Misbehaviour misbehaviour;
};

// Called for each scan that goes out, in order.
using CastScan = std::function<LineReading(std::uint64_t scan)>;

class ScipServer {
 public:
  // Throws std::system_error when the port cannot be had. `sensor` and `timing` must outlive
  // the server.
  ScipServer(const ScipServerOptions& options, ScipSensor& sensor, const LidarTiming& timing,
             CastScan cast_scan);

  int port() const { return port_; }
  void add_to(std::vector<pollfd>& waits, std::int64_t now_ns) const;
  std::int64_t next_event_ns() const;  // when serve() is due though nothing came
  void serve(std::int64_t now_ns);

  // Faults from now on.
  SpoiledFrames& next_frames() { return next_frames_; }
  void stall(double duration_s, std::int64_t now_ns);
  void reset_connection();  // as a router does that forgot it
  void lose_power(double duration_s, std::int64_t now_ns);

  // Lines cast while the client read too slowly to be sent any.
  std::uint64_t scans_dropped() const { return scans_dropped_; }

 private:
  void listen();
  void accept_client();
  void read_client(std::int64_t now_ns);
  void send_due_scans(std::int64_t now_ns);
  void send_frame(std::string frame, std::int64_t now_ns);
  void spoil(std::string& frame);
  void transmit(std::int64_t now_ns);
  void disconnect();

  ScipServerOptions options_;
  ScipSensor* sensor_;
  const LidarTiming* timing_;
  CastScan cast_scan_;
  FileDescriptor listener_;
  FileDescriptor client_;
  int port_ = 0;
  std::string outgoing_;
  std::string glued_;
  SpoiledFrames next_frames_;
  std::uint64_t frames_ = 0;
  std::uint64_t scans_dropped_ = 0;
  bool close_when_sent_ = false;
  std::int64_t stalled_until_ns_ = 0;
  std::int64_t back_at_ns_ = 0;  // after a reboot; 0: not rebooting
};

}  // namespace swivel::sim
