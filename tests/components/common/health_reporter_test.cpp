// What systemd hears of a participant: by its own protocol, datagrams on a socket of its choosing.
#include "components/common/health_reporter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cstring>

#include "tests/components/dds/test_participant.hpp"
#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Systemd {
 public:
  Systemd() : path_(own_path("notify")), socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof(address.sun_path) - 1);
    unlink(path_.c_str());
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~Systemd() {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
    unlink(path_.c_str());
  }
  Systemd(const Systemd&) = delete;
  Systemd& operator=(const Systemd&) = delete;

  // All that was said until `word` was among it, within its next eight messages.
  std::string hear(const std::string& word, int patience_ms = 2000) {
    std::string heard;
    pollfd news{socket_, POLLIN, 0};
    for (int said = 0; said < 8 && heard.find(word) == std::string::npos; ++said) {
      if (poll(&news, 1, patience_ms) != 1) break;
      std::array<char, 512> text{};
      const ssize_t size = recv(socket_, text.data(), text.size(), 0);
      heard +=
          std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))) + "\n";
    }
    return heard;
  }

 private:
  std::string path_;
  int socket_;
};

TEST(HealthReporter, TellsSystemdThatItIsReadyWhatItDoesAndThatItEnds) {
  Systemd systemd;
  {
    Participant participant(loopback_participant("reporter", domain_of_this_test()));
    HealthReporter health(participant);
    health.set_state(msg::HEALTH_WAITING, "waiting for a lidar\nMAINPID=1");
    EXPECT_THAT(systemd.hear("lidar"), Not(HasSubstr("READY"))) << "not started";
    participant.start();
    const std::string heard = systemd.hear("READY=1");
    EXPECT_THAT(heard, HasSubstr("READY=1\nWATCHDOG=1\n"));
    EXPECT_THAT(heard, HasSubstr("STATUS=waiting for a lidar\n"));
    EXPECT_THAT(heard, Not(HasSubstr("MAINPID"))) << "a device's words are no orders";
    participant.stop();  // as the programs do: its ticks are the reporter's
  }
  EXPECT_THAT(systemd.hear("STOPPING"), HasSubstr("STOPPING=1"));
}

TEST(HealthReporter, LeavesAHungProgramToTheWatchdog) {
  Systemd systemd;
  Participant participant(loopback_participant("reporter", domain_of_this_test()));
  HealthReporter health(participant);
  std::atomic<bool> works{false};
  std::atomic<int> asked{0};
  health.watch_over([&] {
    ++asked;
    return works.load();
  });
  participant.start();
  EXPECT_TRUE(wait_until([&] { return asked > 1; }));
  EXPECT_THAT(systemd.hear("WATCHDOG", 0), Not(HasSubstr("WATCHDOG")));
  works = true;
  EXPECT_THAT(systemd.hear("WATCHDOG"), HasSubstr("WATCHDOG=1"));
  participant.stop();
}

}  // namespace
}  // namespace swivel
