#include "components/dds/participant_qos.hpp"

#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fstream>

#include "components/dds/shared_memory.hpp"

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

// Fast DDS itself says nothing, and nothing arrives.
void warn_of_other_users(const fast::DomainParticipantQos& qos) {
  using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
  const auto& transports = qos.transport().user_transports;
  const bool shares = std::any_of(transports.begin(), transports.end(), [](const auto& transport) {
    return dynamic_cast<const SharedMemTransportDescriptor*>(transport.get()) != nullptr;
  });
  if (!shares) return;
  for (const uid_t user : count_shared_memory().other_users) {
    spdlog::warn(
        "user {} runs DDS programs here, and shared memory does not cross users: what they and "
        "we send may not arrive; run as one user, or one side with --network loopback_udp",
        user);
  }
}

void warn_of_small_udp_buffers() {
  int largest_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> largest_bytes;
  if (largest_bytes > 0 && largest_bytes < kUdpBufferBytes) {
    spdlog::warn(
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
  if (options.shared_memory_bytes > 0) set_shared_memory_size(qos, options.shared_memory_bytes);
  return qos;
}

void warn_of_this_computer(const ParticipantOptions& options,
                           const fast::DomainParticipantQos& qos) {
  if (options.network != "loopback") warn_of_small_udp_buffers();
  warn_of_other_users(qos);
}

}  // namespace swivel
