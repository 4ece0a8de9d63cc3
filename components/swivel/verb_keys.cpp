// swivel keys: what participants need to prove who they are, for --security.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ctime>
#include <iostream>
#include <memory>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/keys/key_folder.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kSecondsPerDay = 86400;

struct KeysOptions {
  std::string folder;
  std::string authority_folder;
  std::string rig_file;
  std::string governance_file;
  std::string permissions_file;
  int days = 1825;
};

// From yesterday on: the clocks of two computers differ.
ValidFor valid_for(int days) {
  const std::int64_t now_s = std::time(nullptr);
  return {now_s - kSecondsPerDay, now_s + days * kSecondsPerDay};
}

int make_keys(const KeysOptions& options) {
  const std::string rig = load_rig_file(options.rig_file).rig;
  KeyFolderOptions keys{rig,
                        read_document(options.governance_file),
                        load_grants(options.permissions_file),
                        valid_for(options.days),
                        {}};
  if (!options.authority_folder.empty()) keys.authority = load_authority(options.authority_folder);
  make_key_folder(options.folder, keys);
  std::cout << options.folder << ": keys of " << keys.grants.size() << " participants of rig '"
            << rig << "', for " << options.days << " days\n"
            << "start them with --security; on another computer they need this folder too, without "
            << authority_key_file(options.folder) << ":\nwho has that can make keys; put it away"
            << std::endl;
  return kExitOk;
}

}  // namespace

void add_keys(CLI::App& app, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("keys", "Makes the keys with which participants prove who they are");
  const auto options = std::make_shared<KeysOptions>();
  options->rig_file = shared_file("rigs/yuan.yaml");
  options->governance_file = shared_file("security/governance.xml");
  options->permissions_file = shared_file("security/permissions.yaml");
  verb->add_option("-o,--output", options->folder, "The folder to make")->required();
  verb->add_option("--rig", options->rig_file, "The rig file, or the name of a shipped one")
      ->transform(rig_file_of, "", "rig")
      ->capture_default_str();
  verb->add_option("--days", options->days, "How long they are valid")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  verb->add_option("--authority", options->authority_folder,
                   "A folder made before: its authority, not a new one, so that both folders' keys "
                   "go together");
  verb->add_option("--governance", options->governance_file, "What is encrypted")
      ->capture_default_str();
  verb->add_option("--permissions", options->permissions_file, "Who may write and read what")
      ->capture_default_str();
  verb->callback([=, &chosen] { chosen = [=] { return make_keys(*options); }; });
}

}  // namespace swivel
