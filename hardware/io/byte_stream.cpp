#include "hardware/io/byte_stream.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hardware/io/clock.hpp"
#include "hardware/io/serial_open.hpp"
#include "hardware/io/tcp_connect.hpp"
#include "hardware/io/wait_ready.hpp"

namespace swivel {
namespace {

constexpr std::string_view kTcpScheme = "tcp://";
constexpr std::size_t kMostBytesAtOnce = 16384;

bool nothing_yet(int error) {
  return error == EAGAIN || error == EINTR;
}

// EIO is what a pty or an unplugged USB adapter says.
bool means_closed(int error) {
  return error == EIO || error == ECONNRESET || error == EPIPE || error == ENXIO;
}

Received closed() {
  return {Received::Kind::kClosed, {}, "the other side closed the connection, or was unplugged"};
}

Received failed(int error) {
  return {Received::Kind::kError, {}, std::strerror(error)};
}

bool starts_with(const std::string& text, std::string_view start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

Result<ByteStream> ByteStream::open(const std::string& address, std::chrono::milliseconds timeout,
                                    const WakeUp* wake_up, WireTap tap) {
  const bool is_tcp = starts_with(address, kTcpScheme);
  if (!is_tcp && !starts_with(address, "/"))
    return Failure{address + ": an address is tcp://HOST:PORT or a device such as /dev/ttyACM0"};
  const Result<int> descriptor =
      is_tcp ? tcp_connect(address.substr(kTcpScheme.size()), deadline_after(timeout), wake_up)
             : serial_open(address);
  if (!descriptor) return Failure{address + ": " + descriptor.reason()};
  return ByteStream(*descriptor, is_tcp, address, std::move(tap));
}

ByteStream::ByteStream(int descriptor, bool is_socket, std::string address, WireTap tap)
    : descriptor_(descriptor),
      is_socket_(is_socket),
      address_(std::move(address)),
      tap_(std::move(tap)) {
  tell(WireEvent::Kind::kOpened);
}

ByteStream::ByteStream(ByteStream&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      is_socket_(other.is_socket_),
      address_(std::move(other.address_)),
      tap_(std::move(other.tap_)) {}

ByteStream& ByteStream::operator=(ByteStream&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(is_socket_, other.is_socket_);
  std::swap(address_, other.address_);
  std::swap(tap_, other.tap_);
  return *this;
}

ByteStream::~ByteStream() {
  if (descriptor_ < 0) return;
  tell(WireEvent::Kind::kClosed);
  ::close(descriptor_);
}

void ByteStream::tell(WireEvent::Kind kind, std::string_view bytes) const {
  if (tap_) tap_({kind, now_ns(), bytes});
}

Received ByteStream::lost(Received how) {
  tell(WireEvent::Kind::kHungUp);
  return how;
}

Received ByteStream::take(std::string bytes) {
  tell(WireEvent::Kind::kReceived, bytes);
  return {Received::Kind::kData, std::move(bytes), {}};
}

Received ByteStream::read_some(std::chrono::milliseconds timeout, const WakeUp* wake_up) {
  const Deadline deadline = deadline_after(timeout);
  for (;;) {
    const Wait outcome = wait_ready(descriptor_, POLLIN, deadline, wake_up);
    if (outcome == Wait::kTimeout) return {Received::Kind::kTimeout, {}, {}};
    if (outcome == Wait::kInterrupted) return {Received::Kind::kInterrupted, {}, {}};
    if (outcome == Wait::kError) return failed(errno);
    std::string bytes(kMostBytesAtOnce, '\0');
    const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && nothing_yet(errno)) continue;
    if (count == 0 || (count < 0 && means_closed(errno))) return lost(closed());
    if (count < 0) return lost(failed(errno));
    bytes.resize(static_cast<std::size_t>(count));
    return take(std::move(bytes));
  }
}

Outcome ByteStream::write_all(std::string_view bytes, std::chrono::milliseconds timeout) {
  const Deadline deadline = deadline_after(timeout);
  while (!bytes.empty()) {
    const ssize_t count = is_socket_ ? ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                     : ::write(descriptor_, bytes.data(), bytes.size());
    if (count > 0) {
      tell(WireEvent::Kind::kSent, bytes.substr(0, static_cast<std::size_t>(count)));
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    if (count < 0 && means_closed(errno)) return Failure{address_ + ": " + closed().reason};
    if (count < 0 && !nothing_yet(errno)) return Failure{address_ + ": " + std::strerror(errno)};
    if (bytes.empty()) break;
    const Wait outcome = wait_ready(descriptor_, POLLOUT, deadline, nullptr);
    if (outcome == Wait::kTimeout)
      return Failure{address_ + ": takes no more bytes: the device hangs, or was unplugged"};
    if (outcome == Wait::kError) return Failure{address_ + ": " + std::strerror(errno)};
  }
  return Done{};
}

}  // namespace swivel
