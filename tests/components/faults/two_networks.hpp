// Two computers on this one: network namespaces with a cable between them, which this process is:
// it reads the frames at one end and writes them at the other, or does not. (Debian's kernel could
// do as much with netem, but not every CI's.) For root alone.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

namespace swivel::test {

enum class Machine { kRobot, kWorkstation };

struct Link {
  double loss = 0.0;  // of frames, from 0 to 1
  double delay_s = 0.0;
  double bytes_per_s = 125e6;
};

class TwoNetworks {
 public:
  TwoNetworks();
  ~TwoNetworks();
  TwoNetworks(const TwoNetworks&) = delete;
  TwoNetworks& operator=(const TwoNetworks&) = delete;

  // Empty, or why this computer does not allow it.
  const std::string& refused() const { return refused_; }
  static std::string address(Machine machine);

  // This thread, and the threads and processes that it makes from now on.
  void enter(Machine machine) const;

  // Both ways.
  void set_link(const Link& link);
  // As a pulled cable: the ends see that it is gone.
  void set_cable(bool plugged) const;
  void forbid_multicast() const;

 private:
  std::string name_of(Machine machine) const;
  int open_end(Machine machine);
  Link link() const;
  void carry(int from, int to) const;
  bool run(const std::string& command);

  std::string refused_;
  int home_ = -1;
  mutable std::mutex mutex_;
  Link link_;
  std::atomic<bool> over_{false};
  int robot_end_ = -1;
  int workstation_end_ = -1;
  std::thread there_;
  std::thread back_;
};

}  // namespace swivel::test
