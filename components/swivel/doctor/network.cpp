#include "components/swivel/doctor/network.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <vector>

#include "components/dds/participant.hpp"
#include "hardware/io/byte_stream.hpp"
#include "hardware/lidar/scip_parser.hpp"
#include "hardware/lidar/scip_replies.hpp"

namespace swivel {
namespace {

constexpr auto kAnswersWithin = std::chrono::milliseconds(2000);
constexpr int kEchoPatience_ms = 200;
constexpr const char* kGroup = "239.255.83.87";  // administratively scoped; not that of DDS

struct Interface {
  std::string name;
  in_addr address;
};

// Those that are up, and lead out of this computer.
std::vector<Interface> ipv4_interfaces() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(first, freeifaddrs);
  std::vector<Interface> found;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    const bool usable = (at->ifa_flags & IFF_UP) != 0 && (at->ifa_flags & IFF_LOOPBACK) == 0;
    if (!usable || at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    const auto* const address = reinterpret_cast<const sockaddr_in*>(at->ifa_addr);
    found.push_back({at->ifa_name, address->sin_addr});
  }
  return found;
}

class Socket {
 public:
  Socket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

// A datagram to the group comes back by that interface.
bool echoes(const Interface& interface) {
  const Socket socket;
  sockaddr_in own{};
  own.sin_family = AF_INET;
  socklen_t size = sizeof(own);
  auto* const own_address = reinterpret_cast<sockaddr*>(&own);
  ip_mreq membership{};
  membership.imr_interface = interface.address;
  inet_pton(AF_INET, kGroup, &membership.imr_multiaddr);
  own.sin_addr = membership.imr_multiaddr;  // only what is sent to the group
  const int fd = socket.descriptor();
  if (bind(fd, own_address, size) != 0 || getsockname(fd, own_address, &size) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &interface.address, sizeof(in_addr)) != 0)
    return false;
  const std::string word = "swivel doctor " + std::to_string(getpid());
  if (sendto(fd, word.data(), word.size(), 0, own_address, size) < 0) return false;
  pollfd news{fd, POLLIN, 0};
  std::string heard(word.size(), '\0');
  return poll(&news, 1, kEchoPatience_ms) == 1 && recv(fd, heard.data(), heard.size(), 0) > 0 &&
         heard == word;
}

Result<LidarIdentity> ask_name(ByteStream& connection) {
  const Outcome asked = connection.write_all("VV\n", kAnswersWithin);
  if (!asked) return Failure{asked.reason()};
  scip::Parser parser;
  const auto deadline = std::chrono::steady_clock::now() + kAnswersWithin;
  while (std::chrono::steady_clock::now() < deadline) {
    const Received received = connection.read_some(kAnswersWithin);
    if (received.kind == Received::Kind::kTimeout) break;
    if (received.kind != Received::Kind::kData) return Failure{received.reason};
    for (const scip::Reply& reply : parser.push(received.bytes))
      if (reply.echo == "VV") return scip::decode_identity(reply);
  }
  return Failure{"takes a connection, but no Hokuyo lidar answers there"};
}

Diagnosis unreachable(const std::string& subject, const std::string& words) {
  return {subject, Grade::kBad, words,
          "check power, cable and address; this computer needs an address of the same subnet"};
}

}  // namespace

Diagnosis judge_udp_buffer(std::optional<int> limit_bytes) {
  if (!limit_bytes)
    return {"udp buffer", Grade::kWarn, "net.core.rmem_max cannot be read", "is this Linux?"};
  Diagnosis diagnosis{
      "udp buffer", Grade::kOk, "net.core.rmem_max is " + std::to_string(*limit_bytes), {}};
  if (*limit_bytes >= kUdpBufferBytes) return diagnosis;
  const std::string enough = std::to_string(kUdpBufferBytes);
  diagnosis.grade = Grade::kWarn;
  diagnosis.words += ": clouds come slowly from another computer, or to another vendor's DDS";
  diagnosis.advice = "sudo sysctl -w net.core.rmem_max=" + enough + " net.core.wmem_max=" + enough;
  return diagnosis;
}

Diagnosis check_udp_buffer() {
  int limit_bytes = 0;
  std::ifstream file("/proc/sys/net/core/rmem_max");
  return judge_udp_buffer(file >> limit_bytes ? std::optional(limit_bytes) : std::nullopt);
}

Diagnosis check_multicast(const std::string& network) {
  if (network.rfind("loopback", 0) == 0)
    return {"multicast", Grade::kOk, "not needed on this computer alone (--network loopback)", {}};
  std::string working;
  std::string silent;
  for (const Interface& interface : ipv4_interfaces()) {
    std::string& names = echoes(interface) ? working : silent;
    names += (names.empty() ? "" : ", ") + interface.name;
  }
  if (!working.empty()) return {"multicast", Grade::kOk, "works on " + working, {}};
  return {"multicast", Grade::kBad,
          silent.empty() ? "no network but the loopback" : "does not work on " + silent,
          "connect the network; let the firewall pass UDP to 239.255.0.0/16, ports 7400 and up"};
}

Diagnosis check_lidar(const std::string& address) {
  Result<ByteStream> connection = ByteStream::open(address, kAnswersWithin);
  if (!connection) return unreachable("lidar", connection.reason());
  const Result<LidarIdentity> lidar = ask_name(*connection);
  if (!lidar) return unreachable("lidar", address + ": " + lidar.reason());
  return {"lidar",
          Grade::kOk,
          lidar->product + ", serial number " + lidar->serial_number + ", at " + address,
          {}};
}

Diagnosis check_stepper(const std::string& address) {
  const Result<ByteStream> connection = ByteStream::open(address, kAnswersWithin);
  if (!connection) return unreachable("stepper", connection.reason());
  return {"stepper", Grade::kOk, address + " takes a connection; GRBL was not asked", {}};
}

}  // namespace swivel
