// What Fast DDS keeps in /dev/shm, where processes of one computer hand each other messages.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <set>
#include <string>

namespace swivel {

inline constexpr const char* kSharedMemoryFolder = "/dev/shm";

struct SharedMemoryCensus {
  int stale = 0;  // segments of processes that were killed
  std::uint64_t stale_bytes = 0;
  // Users other than this process's that have segments in use. They and we cannot open each
  // other's: what is sent that way is lost in silence.
  std::set<uid_t> other_users;
};

// Of a folder that cannot be read, nothing.
SharedMemoryCensus count_shared_memory(const std::string& folder = kSharedMemoryFolder);

}  // namespace swivel
