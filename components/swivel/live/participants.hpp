// The participants of a role, started and stopped together.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/common/program.hpp"
#include "components/swivel/live/child_process.hpp"

namespace swivel {

struct ParticipantsOptions {
  std::string role = "all";
  std::string lidar;             // an address instead of the rig file's
  std::string stepper;           // likewise
  std::string calibration_file;  // where alpha_calibrator keeps it
};

// "robot": what the hardware hangs on. "workstation": the rest. "all": both.
const std::vector<std::string>& participants_of(const std::string& role);

class Participants {
 public:
  Participants(const CommonOptions& common, const ParticipantsOptions& options);
  ~Participants() { stop(); }

  // The first that has ended, in words.
  std::optional<std::string> ended();
  int exit_code() const { return exit_code_; }  // of the one that ended

  // The sequencer first: the motor stands before anything else goes.
  void stop();

 private:
  std::vector<std::unique_ptr<ChildProcess>> children_;
  int exit_code_ = 0;
};

}  // namespace swivel
