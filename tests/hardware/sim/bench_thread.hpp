// A bench that runs on a thread of its own for the life of a test, and clients for it.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "hardware/sim/bench.hpp"
#include "hardware/sim/file_descriptor.hpp"

namespace swivel::sim {

class BenchThread {
 public:
  explicit BenchThread(const BenchOptions& options)
      : bench(options), thread_([this] { bench.run(stop_); }) {}
  ~BenchThread() { stop(); }
  void stop() {
    stop_.notify();
    if (thread_.joinable()) thread_.join();
  }

  Bench bench;

 private:
  WakeUp stop_;
  std::thread thread_;
};

// A client that reads until a condition holds, or gives up after a deadline.
class Client {
 public:
  static Client of_lidar(int port) {
    Client client(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    client.connected_ = ::connect(client.descriptor_.get(), reinterpret_cast<sockaddr*>(&address),
                                  sizeof address) == 0;
    return client;
  }
  static Client of_stepper(const std::string& path) {
    Client client(::open(path.c_str(), O_RDWR | O_NOCTTY));
    client.connected_ = client.descriptor_.open();
    return client;
  }

  bool connected() const { return connected_; }
  bool closed_by_peer() const { return closed_; }

  void send(const std::string& bytes) {
    const ssize_t count = ::write(descriptor_.get(), bytes.data(), bytes.size());
    if (count != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("cannot write");
  }

  // Takes everything up to and including `end`; empty when it does not come in time.
  std::string take_through(const std::string& end, double timeout_s = 5.0) {
    const auto found = [&] { return received_.find(end) != std::string::npos; };
    if (!read_until(found, timeout_s)) return {};
    const std::size_t size = received_.find(end) + end.size();
    std::string taken = received_.substr(0, size);
    received_.erase(0, size);
    return taken;
  }
  std::string take_for(double duration_s) {
    read_until([] { return false; }, duration_s);
    return std::exchange(received_, {});
  }
  bool wait_closed(double timeout_s) {
    read_until([&] { return closed_; }, timeout_s);
    return closed_;
  }
  std::size_t reads() const { return reads_; }

 private:
  explicit Client(int descriptor) : descriptor_(descriptor) {}

  template <class Condition>
  bool read_until(const Condition& condition, double timeout_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    while (!condition() && !closed_) {
      const auto left = end - std::chrono::steady_clock::now();
      const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(left).count();
      if (left.count() <= 0) return false;
      pollfd wait{descriptor_.get(), POLLIN, 0};
      if (::poll(&wait, 1, static_cast<int>(left_ms) + 1) > 0) read_some();
    }
    return condition();
  }
  void read_some() {
    char bytes[65536];
    const ssize_t count = ::read(descriptor_.get(), bytes, sizeof bytes);
    if (count <= 0) closed_ = true;
    if (count > 0) received_.append(bytes, static_cast<std::size_t>(count));
    ++reads_;
  }

  FileDescriptor descriptor_;
  std::string received_;
  bool connected_ = false;
  bool closed_ = false;
  std::size_t reads_ = 0;
};

}  // namespace swivel::sim
