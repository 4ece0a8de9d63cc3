// Stops the motor when this process dies. GRBL turns on to the end of its turn without its
// master, no handler runs on SIGKILL, and closing the port tells the controller nothing. So a
// small process of its own holds the port as well, waits until our end of a pipe is closed, and
// stops the motor. It reads nothing from the port, and sends nothing as long as we live.
#pragma once

#include <sys/types.h>

#include <string>

#include "hardware/result.hpp"

namespace swivel {

class MotorGuard {
 public:
  // program: what runs guard_motor; port: a descriptor of the controller's connection.
  static Result<MotorGuard> start(const std::string& program, int port);

  MotorGuard(MotorGuard&& other) noexcept;
  MotorGuard& operator=(MotorGuard&& other) noexcept;
  ~MotorGuard();  // dismisses it: the motor is our own affair again

  bool watches();

 private:
  MotorGuard(pid_t process, int pipe_end) : process_(process), pipe_end_(pipe_end) {}

  pid_t process_ = -1;
  int pipe_end_ = -1;
};

// What the guard does, to its end: waits on `master`, then ends any motion on `port`.
void guard_motor(int master, int port);

}  // namespace swivel
