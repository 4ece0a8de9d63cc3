// The one clock of the robot computer: nanoseconds since 1970-01-01.
#pragma once

#include <chrono>
#include <cstdint>

namespace swivel {

inline std::int64_t now_ns() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace swivel
