// The simulated bench: lidar and stepper on the real wires, in one world, with the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hardware/io/wake_up.hpp"
#include "hardware/sim/control_port.hpp"
#include "hardware/sim/grbl_peer.hpp"
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
  std::string control_path;  // of a Unix socket that takes faults; empty: none
};

class Bench {
 public:
  // Throws std::exception with a message for the user.
  explicit Bench(const BenchOptions& options);

  int port() const { return server_.port(); }
  const std::string& stepper_path() const { return stepper_port_.path(); }

  void run(const WakeUp& stop);  // until `stop` is notified

  // A fault or a question, in words: docs/reliability.md has them all. Answers "ok", with what
  // was asked for, or "error: " and why not.
  std::string obey(const std::string& command, std::int64_t now_ns);

  std::uint64_t lines_sent() const { return lines_sent_; }
  std::uint64_t scans_dropped() const { return server_.scans_dropped(); }
  std::uint64_t stepper_bytes_lost() const { return stepper_.bytes_lost(); }

 private:
  // The commands for the lidar and for the stepper. Nothing: there is no such one.
  std::optional<std::string> obey_lidar(const Command& command, std::int64_t now_ns);
  std::optional<std::string> spoil_frames(const Command& command);
  std::optional<std::string> obey_stepper(const Command& command, std::int64_t now_ns);
  std::optional<std::string> answer(const Command& command, std::int64_t now_ns) const;
  void note_shaft(std::int64_t now_ns);
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
  ControlPort control_;
  double lowest_deg_;  // where the shaft was so far
  double highest_deg_;
  std::uint64_t lines_sent_ = 0;
};

}  // namespace swivel::sim
