// A program of Swivel as a child of this one.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace swivel {

class ChildProcess {
 public:
  // program: its name, beside the running one. Its standard output can be read if asked for.
  // It is told to stop should this process die. Throws ExitError if it cannot be started.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               bool read_output = false);
  ~ChildProcess();  // stops it
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  const std::string& name() const { return name_; }
  pid_t id() const { return id_; }

  // How it ended, in words; none while it runs.
  std::optional<std::string> ended();
  int exit_code() const { return exit_code_; }  // once ended; 128 + signal if it was killed

  void ask_to_stop();
  // Until it has ended; killed when it takes too long. False if it had to be killed.
  bool wait_or_kill(std::chrono::milliseconds patience);

  // The next line of its output; none when it ended or the time is over.
  std::optional<std::string> read_line(std::chrono::milliseconds timeout);

 private:
  bool reap(bool block);

  std::string name_;
  pid_t id_ = -1;
  int output_ = -1;
  std::string unread_;
  bool running_ = true;
  int exit_code_ = 0;
};

}  // namespace swivel
