#include "hardware/stepper/motor_guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "hardware/io/wait_ready.hpp"
#include "hardware/stepper/grbl.hpp"

namespace swivel {
namespace {

// A jog runs down in w / a, 0.25 s on the bench at 180 deg/s; what still turns then, as in
// homing, is cut.
constexpr std::chrono::milliseconds kRunDown{400};
constexpr std::chrono::milliseconds kWritePatience{200};

// A session of its own: Ctrl-C in the terminal reaches the sequencer alone.
int spawn_guard(const std::string& program, int master, int port, pid_t& process) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, master, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, port, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string name = program;
  const std::array<char*, 2> arguments{name.data(), nullptr};
  const int error =
      ::posix_spawn(&process, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

void say(int port, char byte) {
  const Deadline deadline = deadline_after(kWritePatience);
  while (::write(port, &byte, 1) < 0 && (errno == EAGAIN || errno == EINTR)) {
    if (wait_ready(port, POLLOUT, deadline, nullptr) != Wait::kReady) return;
  }
}

}  // namespace

Result<MotorGuard> MotorGuard::start(const std::string& program, int port) {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Failure{std::string("no pipe to the motor's guard: ") + std::strerror(errno)};
  }
  pid_t process = -1;
  const int error = spawn_guard(program, ends[0], port, process);
  ::close(ends[0]);
  if (error == 0) return MotorGuard(process, ends[1]);
  ::close(ends[1]);
  return Failure{program + ": the motor's guard does not start: " + std::strerror(error)};
}

MotorGuard::MotorGuard(MotorGuard&& other) noexcept
    : process_(std::exchange(other.process_, -1)), pipe_end_(std::exchange(other.pipe_end_, -1)) {}

MotorGuard& MotorGuard::operator=(MotorGuard&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(pipe_end_, other.pipe_end_);
  return *this;
}

MotorGuard::~MotorGuard() {
  if (watches()) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  if (pipe_end_ >= 0) ::close(pipe_end_);
}

bool MotorGuard::watches() {
  if (process_ > 0 && ::waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
  return process_ > 0;
}

void guard_motor(int master, int port) {
  char byte = 0;
  while (::read(master, &byte, 1) > 0 || errno == EINTR) errno = 0;
  ::tcflush(port, TCOFLUSH);  // a turn that was not sent yet is not sent at all
  say(port, kGrblJogCancel);
  wait_ready(-1, 0, deadline_after(kRunDown), nullptr);
  say(port, kGrblReset);
}

}  // namespace swivel
