#include "components/dds/participant_qos.hpp"

#include <fastdds/rtps/attributes/ServerAttributes.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <charconv>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fstream>

#include "components/dds/security.hpp"
#include "components/dds/shared_memory.hpp"
#include "components/log/log.hpp"

namespace swivel {

namespace fast = eprosima::fastdds::dds;

namespace {

// The profile's own description stays as it is: other participants of this process share it.
void set_shared_memory_size(fast::DomainParticipantQos& qos, std::uint32_t bytes) {
  using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
  for (auto& transport : qos.transport().user_transports) {
    const auto* const given = dynamic_cast<const SharedMemTransportDescriptor*>(transport.get());
    if (given == nullptr) continue;
    auto smaller = std::make_shared<SharedMemTransportDescriptor>(*given);
    smaller->segment_size(bytes);
    transport = smaller;
  }
}

constexpr std::uint16_t kDiscoveryPort = 11811;  // as Fast DDS's own server has it

using eprosima::fastrtps::rtps::Locator_t;

// Without a port: those of DDS.
Locator_t locator_of(const std::string& address) {
  Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  if (!eprosima::fastrtps::rtps::IPLocator::setIPv4(locator, address))
    throw DdsError("'" + address + "' is no address of a computer: A.B.C.D");
  return locator;
}

Locator_t locator_of_server(const std::string& address) {
  const std::size_t colon = address.find(':');
  Locator_t locator = locator_of(address.substr(0, colon));
  int port = kDiscoveryPort;
  if (colon != std::string::npos) {
    const char* const end = address.data() + address.size();
    const auto [stop, error] = std::from_chars(address.data() + colon + 1, end, port);
    if (error != std::errc() || stop != end || port < 1 || port > 65535)
      throw DdsError("'" + address + "' is no address of a discovery server: A.B.C.D[:PORT]");
  }
  eprosima::fastrtps::rtps::IPLocator::setPhysicalPort(locator, static_cast<std::uint16_t>(port));
  return locator;
}

// On this computer too, where it may be multicast alone that brings participants together.
void set_peers(const ParticipantOptions& options, fast::DomainParticipantQos& qos) {
  if (options.peers.empty()) return;
  auto& peers = qos.wire_protocol().builtin.initialPeersList;
  for (const char* address : {"239.255.0.1", "127.0.0.1"}) peers.push_back(locator_of(address));
  for (const std::string& address : options.peers) peers.push_back(locator_of(address));
}

// One server has the name that all know.
void set_discovery(const ParticipantOptions& options, fast::DomainParticipantQos& qos) {
  using eprosima::fastrtps::rtps::DiscoveryProtocol;
  if (options.discovery_server.empty()) return;
  // Fast DDS 2.9 derives the name of who has keys from them: the server's is not the known one
  // then.
  if (!options.security_folder.empty())
    throw DdsError(
        "--discovery-server does not go with --security; name the other computer: --peer");
  auto& builtin = qos.wire_protocol().builtin;
  eprosima::fastdds::rtps::RemoteServerAttributes server;
  server.ReadguidPrefix(eprosima::fastdds::rtps::DEFAULT_ROS2_SERVER_GUIDPREFIX);
  server.metatrafficUnicastLocatorList.push_back(locator_of_server(options.discovery_server));
  builtin.initialPeersList.clear();
  builtin.metatrafficMulticastLocatorList.clear();
  if (options.serves_discovery) {
    builtin.discovery_config.discoveryProtocol = DiscoveryProtocol::SERVER;
    builtin.metatrafficUnicastLocatorList = server.metatrafficUnicastLocatorList;
    qos.wire_protocol().prefix = server.guidPrefix;
  } else {
    builtin.discovery_config.discoveryProtocol = DiscoveryProtocol::CLIENT;
    builtin.discovery_config.m_DiscoveryServers.push_back(server);
  }
}

// Fast DDS itself says nothing, and nothing arrives.
void warn_of_other_users(const fast::DomainParticipantQos& qos) {
  using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
  const auto& transports = qos.transport().user_transports;
  const bool shares = std::any_of(transports.begin(), transports.end(), [](const auto& transport) {
    return dynamic_cast<const SharedMemTransportDescriptor*>(transport.get()) != nullptr;
  });
  if (!shares) return;
  for (const uid_t user : count_shared_memory().other_users) {
    log_warning(
        "user {} runs DDS programs here, and shared memory does not cross users: what they and "
        "we send may not arrive; run as one user, or one side with --network loopback_udp",
        user);
  }
}

void warn_of_small_udp_buffers() {
  int largest_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> largest_bytes;
  if (largest_bytes > 0 && largest_bytes < kUdpBufferBytes) {
    log_warning(
        "net.core.rmem_max is {} bytes: clouds to other machines may be slow; "
        "as root: sysctl -w net.core.rmem_max={} net.core.wmem_max={}",
        largest_bytes, kUdpBufferBytes, kUdpBufferBytes);
  }
}

}  // namespace

fast::DomainParticipantQos participant_qos(const ParticipantOptions& options) {
  auto* const factory = fast::DomainParticipantFactory::get_instance();
  fast::DomainParticipantQos qos;
  // Fast DDS keeps profiles by name for the whole process, and refuses a second loading.
  if (factory->get_participant_qos_from_profile(options.network, qos) != ReturnCode_t::RETCODE_OK) {
    if (factory->load_XML_profiles_file(options.profiles_path) != ReturnCode_t::RETCODE_OK) {
      throw DdsError("DDS profiles " + options.profiles_path +
                     " cannot be read; name the file with --profiles");
    }
    if (factory->get_participant_qos_from_profile(options.network, qos) !=
        ReturnCode_t::RETCODE_OK) {
      throw DdsError("no participant profile '" + options.network + "' in " +
                     options.profiles_path + "; see --network");
    }
  }
  qos.name((options.rig + "/" + options.name).c_str());
  set_peers(options, qos);
  set_discovery(options, qos);
  set_security(options, qos);
  if (options.shared_memory_bytes > 0) set_shared_memory_size(qos, options.shared_memory_bytes);
  return qos;
}

void warn_of_this_computer(const ParticipantOptions& options,
                           const fast::DomainParticipantQos& qos) {
  if (options.network != "loopback") warn_of_small_udp_buffers();
  warn_of_other_users(qos);
}

}  // namespace swivel
