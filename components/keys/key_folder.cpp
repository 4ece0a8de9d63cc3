#include "components/keys/key_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "components/common/program.hpp"
#include "components/dds/security.hpp"

namespace swivel {
namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
  throw ExitError(kExitCannotWrite, path + ": " + std::strerror(error));
}

// Whoever else may see the folder, nobody opens a file between its making and its closing.
void write_for_owner(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) refuse(path, errno);
  const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  if (close(file) != 0 || !written) refuse(path, written ? errno : error);
}

void make_folder_for_owner(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0) refuse(path, errno);
}

void fill(const std::string& folder, const KeyFolderOptions& options) {
  const Authority authority =
      options.authority ? Authority(*options.authority)
                        : Authority("swivel authority of rig " + options.rig, options.validity);
  const Identity own = authority.identity();
  const SecurityFiles shared = security_files(folder, "");
  write_for_owner(authority_key_file(folder), own.private_key);
  write_for_owner(shared.authority, own.certificate);
  write_for_owner(shared.governance, authority.sign(options.governance));
  for (const Grant& grant : options.grants) {
    const SecurityFiles files = security_files(folder, grant.participant);
    const Identity identity = authority.vouch_for(grant.participant, options.validity);
    make_folder_for_owner(folder + "/" + grant.participant);
    write_for_owner(files.certificate, identity.certificate);
    write_for_owner(files.private_key, identity.private_key);
    write_for_owner(files.permissions,
                    authority.sign(permissions_document(grant, options.rig, options.validity)));
  }
}

// Made under another name; gone again where it did not become whole.
class FolderInTheMaking {
 public:
  explicit FolderInTheMaking(const std::string& folder) : path_(folder + ".XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr) refuse(folder, errno);  // mode 0700
  }
  ~FolderInTheMaking() {
    std::error_code not_there_any_more;
    std::filesystem::remove_all(path_, not_there_any_more);
  }
  FolderInTheMaking(const FolderInTheMaking&) = delete;
  FolderInTheMaking& operator=(const FolderInTheMaking&) = delete;

  const std::string& path() const { return path_; }
  // The kernel refuses where there is a file, or a folder that is not empty.
  void rename_to(const std::string& folder) const {
    if (rename(path_.c_str(), folder.c_str()) == 0) return;
    if (errno != ENOTEMPTY && errno != EEXIST && errno != ENOTDIR) refuse(folder, errno);
    throw ExitError(kExitCannotWrite, folder +
                                          " is there already, and is not overwritten: "
                                          "participants may run with its keys");
  }

 private:
  std::string path_;
};

}  // namespace

std::string authority_key_file(const std::string& folder) {
  return folder + "/authority_private_key.pem";
}

std::string read_document(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  if (content.str().empty()) throw ExitError(kExitNoInput, path + ": cannot be read");
  return content.str();
}

Identity load_authority(const std::string& folder) {
  return {read_document(security_files(folder, "").authority),
          read_document(authority_key_file(folder))};
}

void make_key_folder(const std::string& folder, const KeyFolderOptions& options) {
  const FolderInTheMaking making(folder);
  fill(making.path(), options);
  making.rename_to(folder);
}

}  // namespace swivel
