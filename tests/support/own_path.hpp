// A path that no other test has: ctest runs several at once, each a process of its own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

namespace swivel {

inline std::string own_path(const std::string& name) {
  return testing::TempDir() + std::to_string(getpid()) + "_" + name;
}

}  // namespace swivel
