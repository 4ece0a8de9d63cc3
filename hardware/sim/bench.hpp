// The simulated bench: lidar and stepper on the real wires, in one world, with the truth.
#pragma once

#include <cstdint>
#include <string>

#include "hardware/io/wake_up.hpp"
#include "hardware/sim/grbl_port.hpp"
#include "hardware/sim/scip_server.hpp"
#include "hardware/sim/truth_file.hpp"

namespace swivel::sim {

struct BenchOptions {
  std::uint64_t seed = 1;
  WorldOptions world;
  LidarOptions lidar;
  LidarTimingOptions timing;
  MotorOptions motor;
  ScipServerOptions server;
  std::string stepper_link;  // empty: none
  std::string truth_path;    // empty: no truth is written
};

class Bench {
 public:
  // Throws std::exception with a message for the user.
  explicit Bench(const BenchOptions& options);

  int port() const { return server_.port(); }
  const std::string& stepper_path() const { return stepper_port_.path(); }

  void run(const WakeUp& stop);  // until `stop` is notified

  std::uint64_t lines_sent() const { return lines_sent_; }
  std::uint64_t scans_dropped() const { return server_.scans_dropped(); }
  std::uint64_t stepper_bytes_lost() const { return stepper_.bytes_lost(); }

 private:
  LineReading cast_scan(std::uint64_t scan);
  void note_truth(const BenchOptions& options);
  void note_placement(const std::string& what, const Placement& placement);
  void wait(const WakeUp& stop) const;

  std::int64_t start_ns_;
  World world_;
  Lidar lidar_;
  LidarTiming timing_;
  GrblPeer stepper_;
  ScipSensor sensor_;
  TruthFile truth_;
  ScipServer server_;
  GrblPort stepper_port_;
  std::uint64_t lines_sent_ = 0;
};

}  // namespace swivel::sim
