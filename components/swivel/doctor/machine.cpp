#include "components/swivel/doctor/machine.hpp"

#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "components/dds/shared_memory.hpp"

namespace swivel {
namespace {

constexpr std::uint64_t kMegabyte = 1000 * 1000;
// Each participant takes 42 MB when it starts; the scanner is five, a tool or two come and go.
constexpr std::uint64_t kLeastSharedMemoryBytes = 5 * 42 * kMegabyte;
constexpr std::uint64_t kEnoughSharedMemoryBytes = 8 * 42 * kMegabyte;
constexpr std::uint64_t kLeastDiskBytes = 100 * kMegabyte;  // a sweep with its pictures
constexpr std::uint64_t kEnoughDiskBytes = 2000 * kMegabyte;

std::string megabytes_in_words(std::uint64_t bytes) {
  return std::to_string(bytes / kMegabyte) + " MB";
}

std::optional<std::uint64_t> free_bytes_of(const std::string& folder) {
  struct statvfs file_system {};
  if (statvfs(folder.c_str(), &file_system) != 0) return std::nullopt;
  return std::uint64_t{file_system.f_bavail} * file_system.f_frsize;
}

Diagnosis cannot_look(const std::string& subject, const std::string& what) {
  return {subject, Grade::kBad, what + ": " + std::strerror(errno), "mend that first"};
}

}  // namespace

Diagnosis judge_shared_memory(std::uint64_t free_bytes) {
  Diagnosis diagnosis{
      "shared memory", Grade::kOk, megabytes_in_words(free_bytes) + " free in /dev/shm", {}};
  if (free_bytes >= kEnoughSharedMemoryBytes) return diagnosis;
  diagnosis.grade = free_bytes < kLeastSharedMemoryBytes ? Grade::kBad : Grade::kWarn;
  diagnosis.advice =
      "make /dev/shm larger (mount -o remount,size=1G /dev/shm as root; in Docker "
      "--shm-size=1g), or clear what killed processes left";
  return diagnosis;
}

Diagnosis judge_disk(std::uint64_t free_bytes, const std::string& folder) {
  Diagnosis diagnosis{
      "disk", Grade::kOk, megabytes_in_words(free_bytes) + " free in " + folder, {}};
  if (free_bytes >= kEnoughDiskBytes) return diagnosis;
  diagnosis.grade = free_bytes < kLeastDiskBytes ? Grade::kBad : Grade::kWarn;
  diagnosis.advice = "make room: a sweep takes up to 50 MB with its files and pictures";
  return diagnosis;
}

Diagnosis check_stale_segments(const std::string& folder) {
  const SharedMemoryCensus census = count_shared_memory(folder);
  if (census.stale == 0) return {"stale segments", Grade::kOk, "none in " + folder, {}};
  return {"stale segments", Grade::kWarn,
          std::to_string(census.stale) + " left by processes that were killed, " +
              megabytes_in_words(census.stale_bytes) + " in " + folder,
          "fastdds shm clean (of the package fastdds-tools)"};
}

Diagnosis check_other_users(const std::string& folder) {
  std::string users;
  for (const uid_t user : count_shared_memory(folder).other_users)
    users += (users.empty() ? "" : ", ") + std::to_string(user);
  if (users.empty()) return {"other users", Grade::kOk, "none shares memory here", {}};
  return {"other users", Grade::kWarn,
          "user " + users + " runs DDS programs in shared memory, which does not cross users",
          "run as one user, or one side with --network loopback_udp"};
}

Diagnosis check_shared_memory(const std::string& folder) {
  const auto free_bytes = free_bytes_of(folder);
  return free_bytes ? judge_shared_memory(*free_bytes) : cannot_look("shared memory", folder);
}

Diagnosis check_disk(const std::string& folder) {
  const auto free_bytes = free_bytes_of(folder);
  return free_bytes ? judge_disk(*free_bytes, folder) : cannot_look("disk", folder);
}

Diagnosis check_clock() {
  timex clock{};
  const int state = adjtimex(&clock);
  if (state >= 0 && state != TIME_ERROR && (clock.status & STA_UNSYNC) == 0) {
    return {"clock",
            Grade::kOk,
            "synchronised to " + std::to_string(clock.maxerror / 1000) + " ms or better",
            {}};
  }
  return {"clock", Grade::kWarn, "not synchronised: stamps tell no true time of day",
          "timedatectl set-ntp true, or chrony where there is no internet"};
}

Diagnosis check_serial_port(const std::string& subject, const std::string& address) {
  const std::string path = address.substr(0, address.find('@'));
  if (access(path.c_str(), R_OK | W_OK) == 0)
    return {subject, Grade::kOk, path + " is there and may be used", {}};
  const std::string words = path + ": " + std::strerror(errno);
  if (errno == EACCES) {
    return {subject, Grade::kBad, words, "sudo usermod -aG dialout $USER, and log in anew"};
  }
  return {subject, Grade::kBad, words, "plug it in, or name the right port with --" + subject};
}

}  // namespace swivel
