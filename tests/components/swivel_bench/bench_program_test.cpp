// swivel-bench as a script sees it: one line on standard output, and a clean end on a signal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "tests/support/own_path.hpp"

namespace {

using ::testing::MatchesRegex;

class Program {
 public:
  explicit Program(const std::string& link) {
    int ends[2];
    if (::pipe(ends) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::execl(SWIVEL_BENCH, "swivel-bench", "--config", SWIVEL_CONFIG "/benches/yuan.yaml",
              "--stepper-link", link.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    output_ = ends[0];
  }
  ~Program() {
    if (process_ > 0) ::kill(process_, SIGKILL);
    if (process_ > 0) ::waitpid(process_, nullptr, 0);
    ::close(output_);
  }

  std::string first_line() const {
    std::string line;
    char c = 0;
    while (::read(output_, &c, 1) == 1 && c != '\n') line += c;
    return line;
  }

  // The exit code, or nothing when it does not end in time.
  std::optional<int> end_on(int signal, std::chrono::milliseconds limit) {
    ::kill(process_, signal);
    const auto deadline = std::chrono::steady_clock::now() + limit;
    int status = 0;
    while (::waitpid(process_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > deadline) return std::nullopt;
      std::this_thread::yield();
    }
    process_ = -1;
    return WIFEXITED(status) ? std::optional<int>(WEXITSTATUS(status)) : std::nullopt;
  }

 private:
  pid_t process_ = -1;
  int output_ = -1;
};

class SwivelBench : public ::testing::TestWithParam<int> {};

TEST_P(SwivelBench, SaysItsAddressesAndEndsCleanlyOnASignal) {
  const std::string link = swivel::own_path("swivel_bench_link");
  Program bench(link);
  EXPECT_THAT(bench.first_line(),
              MatchesRegex("lidar tcp://127.0.0.1:[0-9]+ stepper .*swivel_bench_link"));
  EXPECT_TRUE(std::filesystem::exists(link));
  EXPECT_EQ(bench.end_on(GetParam(), std::chrono::seconds(1)), 0);
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
}

INSTANTIATE_TEST_SUITE_P(Signals, SwivelBench, ::testing::Values(SIGINT, SIGTERM));

}  // namespace
