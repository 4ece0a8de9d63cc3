// What a participant asks of Fast DDS, and what of this computer may be in its way.
#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "components/dds/participant.hpp"

namespace swivel {

// Throws DdsError where the profiles cannot be read or do not have that network.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const ParticipantOptions& options);

// In the log: other users' shared memory, small buffers. Fast DDS itself says nothing.
void warn_of_this_computer(const ParticipantOptions& options,
                           const eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace swivel
