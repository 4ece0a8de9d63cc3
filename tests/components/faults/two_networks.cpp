#include "tests/components/faults/two_networks.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <random>

namespace swivel::test {
namespace {

using std::chrono::steady_clock;

constexpr Machine kMachines[] = {Machine::kRobot, Machine::kWorkstation};
constexpr std::size_t kLongestFrame = 2048;
constexpr int kFramesAtOnce = 32;
constexpr std::size_t kQueuedBytes = 1 << 20;  // what a switch holds; the rest is dropped
constexpr const char* kCable = "cable";

bool succeeds(const std::string& command) {
  return std::system((command + " 2>/dev/null").c_str()) == 0;
}

void must(const std::string& command) {
  EXPECT_TRUE(succeeds(command)) << command;
}

std::chrono::nanoseconds duration_of(double seconds) {
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

// What is on the way: first come, first served, no faster than the link.
class Queue {
 public:
  void add(std::string frame, const Link& link) {
    if (bytes_ + frame.size() > kQueuedBytes) return;
    if (std::bernoulli_distribution(link.loss)(random_)) return;
    const auto now = steady_clock::now();
    free_ =
        std::max(free_, now) + duration_of(static_cast<double>(frame.size()) / link.bytes_per_s);
    bytes_ += frame.size();
    frames_.push_back({free_ + duration_of(link.delay_s), std::move(frame)});
  }

  void deliver_due(int to) {
    while (!frames_.empty() && frames_.front().due <= steady_clock::now()) {
      const std::string& frame = frames_.front().bytes;
      // Refused where the cable is unplugged: lost, as it should be.
      [[maybe_unused]] const ssize_t written = write(to, frame.data(), frame.size());
      bytes_ -= frame.size();
      frames_.pop_front();
    }
  }

  // Until the next is due, or a while.
  timespec pause() const {
    auto left = std::chrono::nanoseconds(std::chrono::milliseconds(50));
    if (!frames_.empty())
      left = std::min<std::chrono::nanoseconds>(left, frames_.front().due - steady_clock::now());
    return {0, std::max<long>(left.count(), 0)};
  }

 private:
  struct Frame {
    steady_clock::time_point due;
    std::string bytes;
  };
  std::deque<Frame> frames_;
  std::size_t bytes_ = 0;
  steady_clock::time_point free_;
  std::mt19937 random_{7};
};

}  // namespace

TwoNetworks::TwoNetworks() : home_(open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC)) {
  for (const Machine machine : kMachines) {
    const std::string name = name_of(machine);
    if (!run("ip netns add " + name) || !run("ip -n " + name + " link set lo up")) return;
  }
  robot_end_ = open_end(Machine::kRobot);
  workstation_end_ = open_end(Machine::kWorkstation);
  if (!refused_.empty()) return;
  there_ = std::thread([this] { carry(robot_end_, workstation_end_); });
  back_ = std::thread([this] { carry(workstation_end_, robot_end_); });
}

TwoNetworks::~TwoNetworks() {
  over_ = true;
  if (there_.joinable()) there_.join();
  if (back_.joinable()) back_.join();
  if (home_ >= 0) setns(home_, CLONE_NEWNET);
  for (const int end : {robot_end_, workstation_end_, home_}) {
    if (end >= 0) close(end);
  }
  for (const Machine machine : kMachines) succeeds("ip netns delete " + name_of(machine));
}

bool TwoNetworks::run(const std::string& command) {
  if (succeeds(command)) return true;
  refused_ = "it takes root, iproute2, and a kernel with netns and tun; failed: " + command;
  return false;
}

std::string TwoNetworks::name_of(Machine machine) const {
  return "swivel_" + std::to_string(getpid()) +
         (machine == Machine::kRobot ? "_robot" : "_workstation");
}

std::string TwoNetworks::address(Machine machine) {
  return machine == Machine::kRobot ? "10.83.87.1" : "10.83.87.2";
}

// The machine's network card, and our end of it.
int TwoNetworks::open_end(Machine machine) {
  const std::string ip = "ip -n " + name_of(machine);
  enter(machine);
  const int end = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::string(kCable).copy(request.ifr_name, sizeof request.ifr_name - 1);
  if (end < 0 || ioctl(end, TUNSETIFF, &request) != 0) {
    refused_ = "it takes root and /dev/net/tun";
  } else if (run(ip + " address add " + address(machine) + "/24 dev cable")) {
    run(ip + " link set cable up");
  }
  setns(home_, CLONE_NEWNET);
  return end;
}

void TwoNetworks::enter(Machine machine) const {
  const std::string path = "/run/netns/" + name_of(machine);
  const int name_space = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(setns(name_space, CLONE_NEWNET), 0) << path;
  close(name_space);
}

void TwoNetworks::set_link(const Link& link) {
  const std::lock_guard lock(mutex_);
  link_ = link;
}

Link TwoNetworks::link() const {
  const std::lock_guard lock(mutex_);
  return link_;
}

void TwoNetworks::carry(int from, int to) const {
  Queue queue;
  std::array<char, kLongestFrame> frame{};
  while (!over_) {
    const timespec pause = queue.pause();
    pollfd news{from, POLLIN, 0};
    ppoll(&news, 1, &pause, nullptr);
    for (int count = 0; count < kFramesAtOnce; ++count) {
      const ssize_t size = read(from, frame.data(), frame.size());
      if (size <= 0) break;
      queue.add(std::string(frame.data(), static_cast<std::size_t>(size)), link());
    }
    queue.deliver_due(to);
  }
}

void TwoNetworks::set_cable(bool plugged) const {
  for (const Machine machine : kMachines)
    must("ip -n " + name_of(machine) + " link set cable carrier " + (plugged ? "on" : "off"));
}

void TwoNetworks::forbid_multicast() const {
  for (const Machine machine : kMachines)
    must("ip -n " + name_of(machine) + " link set cable multicast off");
}

}  // namespace swivel::test
