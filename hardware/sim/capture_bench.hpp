// A bench that has no world: a captured lidar and a captured stepper, on their real wires.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/io/wake_up.hpp"
#include "hardware/sim/captured_device.hpp"
#include "hardware/sim/grbl_port.hpp"
#include "hardware/sim/tcp_port.hpp"

namespace swivel::sim {

// What acts on GRBL without a line's end: the question how it stands, hold, resume, reset, cancel.
inline constexpr const char* kGrblAtOnce = "?!~\x18\x85";

struct CaptureBenchOptions {
  std::vector<Conversation> lidar;    // a connection each, in order of time
  std::vector<Conversation> stepper;  // split by kGrblAtOnce
  int port = 0;                       // of the lidar; 0: any free one
  std::string stepper_link;           // empty: none
};

class CaptureBench {
 public:
  // Throws std::system_error.
  CaptureBench(CaptureBenchOptions options, CapturedDevice::OnNews on_news);

  int port() const { return lidar_port_.port(); }
  const std::string& stepper_path() const { return stepper_port_.path(); }

  void run(const WakeUp& stop);  // until `stop` is notified

  // How often something else was asked than in the capture.
  std::uint64_t differences() const { return lidar_.differences() + stepper_.differences(); }

 private:
  CapturedDevice lidar_;
  CapturedDevice stepper_;
  TcpPort lidar_port_;
  GrblPort stepper_port_;
};

}  // namespace swivel::sim
