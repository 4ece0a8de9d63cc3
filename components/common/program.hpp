// What every program of Swivel has in common: its options, its log, how it stops and how it
// ends.
#pragma once

#include <signal.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/dds/participant.hpp"

namespace CLI {
class App;
}

namespace swivel {

// As sysexits.h has them, so that a service manager can tell what is worth a restart.
enum ExitCode {
  kExitOk = 0,
  kExitUsage = 64,
  kExitBadData = 65,
  kExitNoInput = 66,
  kExitUnavailable = 69,  // a device, or the participants
  kExitInternal = 70,
  kExitCannotWrite = 73,
  kExitInputOutput = 74,
  kExitTryAgain = 75,
  kExitConfiguration = 78,
};

// Ends a program with a code and one line that says what to do.
struct ExitError : std::runtime_error {
  ExitError(ExitCode exit_code, const std::string& what)
      : std::runtime_error(what), code(exit_code) {}
  ExitCode code;
};

// SIGINT and SIGTERM, blocked from its construction on, so that they reach wait_for alone. Must
// be made before any thread.
class StopSignal {
 public:
  StopSignal();
  // True once the program was told to stop.
  bool wait_for(std::chrono::milliseconds timeout);
  bool received() { return wait_for(std::chrono::milliseconds(0)); }
  void wait();

 private:
  sigset_t signals_;
  bool received_ = false;
};

// The same words in every program.
struct CommonOptions {
  std::string rig_file;
  std::string profiles_file;
  std::string network = "loopback";
  std::string discovery_server;
  std::vector<std::string> peers;
  std::string security_folder;
  std::string log_level = "info";
  int domain = 0;

  ParticipantOptions participant(const std::string& name, const std::string& rig) const;
  // For another program of ours, to meet this one.
  std::vector<std::string> as_arguments() const;
};

// share/swivel beside the directory of the running program.
std::string shared_file(const std::string& name);
std::string program_directory();

// The file of a shipped rig, where its name alone is given; else the path as it is.
std::string rig_file_of(const std::string& path_or_name);

void add_common_options(CLI::App& app, CommonOptions& options);
void start_log(const std::string& program, const std::string& level);

// Parses the options, runs body, turns what it throws into one line and an exit code.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

// The main() of a participant: the common options and its own, its log, its end.
class ParticipantProgram {
 public:
  ParticipantProgram(std::string name, const std::string& purpose);
  ~ParticipantProgram();

  // An option of this participant alone; empty if it is not given.
  void add_option(const std::string& name, std::string& value, const std::string& purpose);

  // The body returns once it was told to stop and has stopped.
  int run(int argc, char** argv,
          const std::function<void(const CommonOptions& options, StopSignal& stop)>& body);

 private:
  StopSignal stop_;  // before any thread
  std::string name_;
  CommonOptions options_;
  std::unique_ptr<CLI::App> app_;
};

}  // namespace swivel
