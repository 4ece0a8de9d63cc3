// What a scanner needs of the network: to its lidar, and to its other half.
#pragma once

#include <optional>
#include <string>

#include "components/swivel/doctor/diagnosis.hpp"

namespace swivel {

Diagnosis judge_udp_buffer(std::optional<int> limit_bytes);

Diagnosis check_udp_buffer();
// Sends to a group of this computer's own on each interface, and listens. `network` as in
// CommonOptions: on the loopback nobody needs it.
Diagnosis check_multicast(const std::string& network);
// tcp://HOST:PORT. Of the lidar it asks the name and nothing else: a scan goes on undisturbed.
Diagnosis check_lidar(const std::string& address);
Diagnosis check_stepper(const std::string& address);

}  // namespace swivel
