#include "components/dds/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace swivel {
namespace {

// A living process holds a lock on the file beside its segment.
bool is_in_use(const std::string& segment) {
  const int descriptor = open((segment + "_el").c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno != ENOENT;
  const bool free = flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  close(descriptor);
  return !free;
}

// fastrtps_0123456789abcdef, not its lock and not a port.
bool is_segment(const std::string& name) {
  const std::string prefix = "fastrtps_";
  return name.compare(0, prefix.size(), prefix) == 0 &&
         name.find_first_not_of("0123456789abcdef", prefix.size()) == std::string::npos;
}

}  // namespace

SharedMemoryCensus count_shared_memory(const std::string& folder) {
  SharedMemoryCensus census;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
    struct stat status {};
    const std::string path = entry.path();
    if (!is_segment(entry.path().filename()) || stat(path.c_str(), &status) != 0) continue;
    if (!is_in_use(path)) {
      ++census.stale;
      census.stale_bytes += static_cast<std::uint64_t>(status.st_size);
    } else if (status.st_uid != geteuid()) {
      census.other_users.insert(status.st_uid);
    }
  }
  return census;
}

}  // namespace swivel
