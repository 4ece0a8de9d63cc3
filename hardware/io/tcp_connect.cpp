#include "hardware/io/tcp_connect.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <future>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace swivel {
namespace {

constexpr std::chrono::milliseconds kLookupStep{5};

struct HostAndPort {
  std::string host;
  std::string port;
};

struct SocketAddress {
  sockaddr_storage address{};
  socklen_t size = 0;
};

struct Lookup {
  int error = 0;  // of getaddrinfo
  std::vector<SocketAddress> addresses;
};

bool is_port(const std::string& text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, port);
  return error == std::errc{} && stopped == end && port >= 1 && port <= 65535;
}

Result<HostAndPort> split_port(const std::string& host_and_port) {
  const auto colon = host_and_port.rfind(':');
  if (colon == std::string::npos || colon == 0)
    return Failure{"a TCP address reads tcp://HOST:PORT"};
  HostAndPort parts{host_and_port.substr(0, colon), host_and_port.substr(colon + 1)};
  if (!is_port(parts.port))
    return Failure{"the port '" + parts.port + "' is not a number from 1 to 65535"};
  if (parts.host.size() > 2 && parts.host.front() == '[' && parts.host.back() == ']')
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  return parts;
}

Lookup look_up(const HostAndPort& target, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  Lookup lookup;
  lookup.error = ::getaddrinfo(target.host.c_str(), target.port.c_str(), &hints, &found);
  if (lookup.error != 0) return lookup;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    SocketAddress& kept = lookup.addresses.emplace_back();
    std::memcpy(&kept.address, one->ai_addr, one->ai_addrlen);
    kept.size = one->ai_addrlen;
  }
  ::freeaddrinfo(found);
  return lookup;
}

// A name server that does not answer holds getaddrinfo for many seconds and cannot be
// interrupted, so a thread of its own waits for it and is left behind at the deadline.
std::optional<Lookup> look_up_until(const HostAndPort& target, Deadline deadline,
                                    const WakeUp* wake_up) {
  Lookup numeric = look_up(target, AI_NUMERICHOST);
  if (numeric.error == 0) return numeric;
  std::packaged_task<Lookup()> task([target] { return look_up(target, 0); });
  std::future<Lookup> answer = task.get_future();
  std::thread(std::move(task)).detach();
  while (answer.wait_for(kLookupStep) != std::future_status::ready) {
    const Wait outcome =
        wait_ready(-1, 0, std::min(deadline, deadline_after(kLookupStep)), wake_up);
    if (outcome == Wait::kInterrupted || std::chrono::steady_clock::now() >= deadline)
      return std::nullopt;
  }
  return answer.get();
}

std::string connect_reason(int error) {
  switch (error) {
    case ECONNREFUSED:
      return "connection refused: the host is there, but nothing listens on this port; check "
             "the port, and that the device has started";
    case EHOSTUNREACH:
    case ENETUNREACH:
    case EHOSTDOWN:
      return "host unreachable: check the cable, the address, and that this computer has an "
             "address in the same network";
    case ETIMEDOUT:
      return "no answer: check the power, the cable and the address";
    default:
      return std::string(std::strerror(error));
  }
}

// 0, or what went wrong, as an errno; ECANCELED when interrupted.
int finish_connecting(int descriptor, Deadline deadline, const WakeUp* wake_up) {
  const Wait outcome = wait_ready(descriptor, POLLOUT, deadline, wake_up);
  if (outcome == Wait::kTimeout) return ETIMEDOUT;
  if (outcome == Wait::kInterrupted) return ECANCELED;
  if (outcome == Wait::kError) return errno;
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

Result<int> connect_one(const SocketAddress& target, Deadline deadline, const WakeUp* wake_up) {
  const int descriptor =
      ::socket(target.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return Failure{connect_reason(errno)};
  // Requests are a few bytes and their round trip is measured: do not collect them.
  const int on = 1;
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  int error = 0;
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&target.address), target.size) != 0)
    error = errno;
  if (error == EINPROGRESS || error == EINTR)
    error = finish_connecting(descriptor, deadline, wake_up);
  if (error == 0) return descriptor;
  ::close(descriptor);
  return Failure{error == ECANCELED ? "interrupted while connecting" : connect_reason(error)};
}

}  // namespace

Result<int> tcp_connect(const std::string& host_and_port, Deadline deadline,
                        const WakeUp* wake_up) {
  const Result<HostAndPort> target = split_port(host_and_port);
  if (!target) return Failure{target.reason()};
  const std::optional<Lookup> lookup = look_up_until(*target, deadline, wake_up);
  if (!lookup)
    return Failure{"no name server answered for '" + target->host + "': give the number instead"};
  if (lookup->error != 0)
    return Failure{"the name '" + target->host + "' is not known (" +
                   ::gai_strerror(lookup->error) + "): check it, or give the number instead"};
  std::string reason = "the name has no address";
  for (const SocketAddress& address : lookup->addresses) {
    Result<int> connected = connect_one(address, deadline, wake_up);
    if (connected) return connected;
    reason = connected.reason();
  }
  return Failure{reason};
}

}  // namespace swivel
