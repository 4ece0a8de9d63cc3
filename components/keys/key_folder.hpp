// The folder of keys that --security names: an authority, the governance that it signed, and for
// each participant a folder with its certificate, its private key and its permissions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/keys/permissions.hpp"

namespace swivel {

struct KeyFolderOptions {
  std::string rig;
  std::string governance;  // the document
  std::vector<Grant> grants;
  ValidFor validity;
  std::optional<Identity> authority;  // none: a new one
};

// The authority's private key; no participant needs it.
std::string authority_key_file(const std::string& folder);

// The governance, as it is before it is signed. Throws ExitError.
std::string read_document(const std::string& path);

// Of a folder made before: keys of one authority go together, of whatever folder. Throws ExitError.
Identity load_authority(const std::string& folder);

// Appears whole or not at all, and for its owner alone. Throws ExitError where there is something
// already, or it cannot be written.
void make_key_folder(const std::string& folder, const KeyFolderOptions& options);

}  // namespace swivel
