// DDS Security: who a participant proves to be, and what Fast DDS is told of it. `swivel keys`
// makes the files; config/security says who may do what.
#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include <string>

#include "components/dds/participant.hpp"

namespace swivel {

// What a participant needs, in a folder of keys.
struct SecurityFiles {
  std::string authority;    // the certificate of who signed all the others
  std::string governance;   // signed
  std::string certificate;  // the participant's own, like the two that follow
  std::string private_key;
  std::string permissions;  // signed
};

SecurityFiles security_files(const std::string& folder, const std::string& participant);

// Nothing where options name no folder. Throws DdsError where a file cannot be read, or the private
// key can be read by everybody.
void set_security(const ParticipantOptions& options,
                  eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace swivel
