// Who may write and read which topics: config/security/permissions.yaml, and the documents that DDS
// Security makes of it.
#pragma once

#include <string>
#include <vector>

#include "components/keys/certificates.hpp"

namespace swivel {

struct Grant {
  std::string participant;
  std::vector<std::string> writes;  // topics without the rig's name: "scan_line"
  std::vector<std::string> reads;
};

// Throws ConfigurationError, also where a topic is none of ours.
std::vector<Grant> load_grants(const std::string& path);

// The permissions document of one participant, to be signed: these topics of this rig, and no
// others.
std::string permissions_document(const Grant& grant, const std::string& rig, ValidFor validity);

}  // namespace swivel
