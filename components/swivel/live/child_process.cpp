#include "components/swivel/live/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "components/common/program.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

[[noreturn]] void become(const std::string& path, const std::vector<std::string>& arguments,
                         int output) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (output >= 0) dup2(output, STDOUT_FILENO);
  std::vector<char*> values{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) {
    values.push_back(const_cast<char*>(argument.c_str()));
  }
  values.push_back(nullptr);
  execv(path.c_str(), values.data());
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           bool read_output)
    : name_(program) {
  const std::string path = program_directory() + "/" + program;
  if (access(path.c_str(), X_OK) != 0) {
    throw ExitError(kExitUnavailable, path + ": not there; it belongs beside swivel");
  }
  std::array<int, 2> ends{-1, -1};
  if (read_output && pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw ExitError(kExitInternal, std::string("no pipe: ") + std::strerror(errno));
  }
  id_ = fork();
  if (id_ < 0) throw ExitError(kExitInternal, std::string("no process: ") + std::strerror(errno));
  if (id_ == 0) become(path, arguments, ends[1]);
  if (ends[1] >= 0) close(ends[1]);
  output_ = ends[0];
}

ChildProcess::~ChildProcess() {
  ask_to_stop();
  wait_or_kill(std::chrono::seconds(3));
  if (output_ >= 0) close(output_);
}

bool ChildProcess::reap(bool block) {
  if (!running_) return true;
  int status = 0;
  if (waitpid(id_, &status, block ? 0 : WNOHANG) != id_) return false;
  running_ = false;
  exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return true;
}

std::optional<std::string> ChildProcess::ended() {
  if (!reap(false)) return std::nullopt;
  if (exit_code_ > 128) {
    return name_ + " was killed: " + strsignal(exit_code_ - 128);
  }
  return name_ + " ended with exit code " + std::to_string(exit_code_);
}

void ChildProcess::ask_to_stop() {
  if (!reap(false)) kill(id_, SIGTERM);
}

bool ChildProcess::wait_or_kill(std::chrono::milliseconds patience) {
  const auto deadline = steady_clock::now() + patience;
  while (!reap(false)) {
    if (steady_clock::now() > deadline) {
      kill(id_, SIGKILL);
      reap(true);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

std::optional<std::string> ChildProcess::read_line(std::chrono::milliseconds timeout) {
  const auto deadline = steady_clock::now() + timeout;
  while (true) {
    if (const std::size_t end = unread_.find('\n'); end != std::string::npos) {
      const std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    pollfd ready{output_, POLLIN, 0};
    if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) <= 0)
      return std::nullopt;
    std::array<char, 512> text{};
    const ssize_t count = read(output_, text.data(), text.size());
    if (count <= 0) return std::nullopt;
    unread_.append(text.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace swivel
