#include "hardware/sim/tcp_port.hpp"

#include <sys/socket.h>

#include <cerrno>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {

TcpPort::TcpPort(CapturedDevice& device, int port)
    : device_(&device), listener_(listen_on_loopback(port)) {}

void TcpPort::add_to(std::vector<pollfd>& waits) const {
  const bool sends = !outgoing_.empty();
  if (client_.open()) {
    waits.push_back({client_.get(), static_cast<short>(sends ? POLLIN | POLLOUT : POLLIN), 0});
  } else {
    waits.push_back({listener_.descriptor.get(), POLLIN, 0});
  }
}

std::int64_t TcpPort::next_event_ns(std::int64_t now_ns) const {
  return client_.open() ? device_->next_event_ns(now_ns) : kNever_ns;
}

void TcpPort::serve(std::int64_t now_ns) {
  if (client_.open()) read_client(now_ns);
  if (!client_.open()) {
    client_ = accept_next(listener_.descriptor);
    outgoing_.clear();
    close_when_sent_ = false;
    if (client_.open()) device_->power_up(now_ns);
  }
  if (!client_.open()) return;
  device_->advance(now_ns);
  outgoing_ += device_->take_output();
  close_when_sent_ = close_when_sent_ || device_->takes_leave();
  write_client();
  if (close_when_sent_ && outgoing_.empty()) client_.close();
}

void TcpPort::read_client(std::int64_t now_ns) {
  char bytes[4096];
  const ssize_t count = ::recv(client_.get(), bytes, sizeof bytes, 0);
  if (count > 0) {
    device_->receive({bytes, static_cast<std::size_t>(count)}, now_ns);
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    client_.close();
  }
}

void TcpPort::write_client() {
  if (outgoing_.empty()) return;
  const ssize_t count = ::send(client_.get(), outgoing_.data(), outgoing_.size(), MSG_NOSIGNAL);
  if (count > 0) outgoing_.erase(0, static_cast<std::size_t>(count));
  if (count < 0 && errno != EAGAIN && errno != EINTR) client_.close();
}

}  // namespace swivel::sim
