// Takes commands to the bench, one a line, on a Unix socket that only its owner can use, and
// answers each with a line.
#pragma once

#include <poll.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hardware/sim/file_descriptor.hpp"

namespace swivel::sim {

// "lidar stall 0.5": whom it is for, what to do, and the rest.
struct Command {
  std::string target;
  std::string verb;
  std::vector<std::string> arguments;

  static Command parse(const std::string& line);
  // The argument, a number within these bounds; nothing if it is none.
  std::optional<double> number(std::size_t argument, double lowest, double highest) const;
};

class ControlPort {
 public:
  using Obey = std::function<std::string(const std::string& command)>;

  // An empty path: nobody can connect. Throws std::system_error.
  explicit ControlPort(const std::string& path);
  ~ControlPort();
  ControlPort(const ControlPort&) = delete;
  ControlPort& operator=(const ControlPort&) = delete;

  void add_to(std::vector<pollfd>& waits) const;
  void serve(const Obey& obey);  // never blocks; one client at a time

 private:
  void take_lines(const Obey& obey);

  std::string path_;
  FileDescriptor listener_;
  FileDescriptor client_;
  std::string received_;
};

}  // namespace swivel::sim
