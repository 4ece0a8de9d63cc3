#include "components/dds/security.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

namespace swivel {

namespace fast = eprosima::fastdds::dds;

namespace {

// Fast DDS itself says little of what it cannot read.
void check_readable(const std::string& path, const ParticipantOptions& options) {
  if (access(path.c_str(), R_OK) == 0) return;
  throw DdsError(path + ": " + std::strerror(errno) + "; " + options.name + " has its keys in " +
                 options.security_folder +
                 ", which 'swivel keys' makes; is it this user's, was all of it copied?");
}

void check_private(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || (status.st_mode & S_IRWXO) == 0) return;
  throw DdsError(path + ": everybody may read this private key; chmod 600 it");
}

// Who joins sends certificate and permissions in one message, which Fast DDS does not cut.
constexpr std::uint32_t kLongestIntroductionBytes = 12000;

// The profile's own description stays as it is: other participants of this process share it.
void let_introductions_pass(fast::DomainParticipantQos& qos) {
  using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
  for (auto& transport : qos.transport().user_transports) {
    const auto* const given = dynamic_cast<const UDPv4TransportDescriptor*>(transport.get());
    if (given == nullptr || given->maxMessageSize >= kLongestIntroductionBytes) continue;
    auto larger = std::make_shared<UDPv4TransportDescriptor>(*given);
    larger->maxMessageSize = kLongestIntroductionBytes;
    transport = larger;
  }
}

}  // namespace

SecurityFiles security_files(const std::string& folder, const std::string& participant) {
  const std::string own = folder + "/" + participant;
  return {folder + "/authority.pem", folder + "/governance.p7s", own + "/certificate.pem",
          own + "/private_key.pem", own + "/permissions.p7s"};
}

void set_security(const ParticipantOptions& options, fast::DomainParticipantQos& qos) {
  if (options.security_folder.empty()) return;
  const std::string folder = std::filesystem::absolute(options.security_folder);
  const SecurityFiles files = security_files(folder, options.name);
  for (const std::string& path : {files.authority, files.governance, files.certificate,
                                  files.private_key, files.permissions}) {
    check_readable(path, options);
  }
  check_private(files.private_key);
  let_introductions_pass(qos);
  auto& properties = qos.properties().properties();
  const std::string identity = "dds.sec.auth.builtin.PKI-DH.";
  const std::string access = "dds.sec.access.builtin.Access-Permissions.";
  properties.emplace_back("dds.sec.auth.plugin", "builtin.PKI-DH");
  properties.emplace_back(identity + "identity_ca", "file://" + files.authority);
  properties.emplace_back(identity + "identity_certificate", "file://" + files.certificate);
  properties.emplace_back(identity + "private_key", "file://" + files.private_key);
  properties.emplace_back("dds.sec.access.plugin", "builtin.Access-Permissions");
  properties.emplace_back(access + "permissions_ca", "file://" + files.authority);
  properties.emplace_back(access + "governance", "file://" + files.governance);
  properties.emplace_back(access + "permissions", "file://" + files.permissions);
  properties.emplace_back("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
}

}  // namespace swivel
