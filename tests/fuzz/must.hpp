// What has to hold whatever the bytes are.
#pragma once

#include <cstdlib>

namespace swivel::fuzz {

inline void must(bool holds) {
  if (!holds) std::abort();
}

}  // namespace swivel::fuzz
