// The program as a user runs it; it stands beside the tests.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "scratch_folder.hpp"

namespace swivel {

// The exit code. What it says goes to the files out and err.
inline int run_swivel(const ScratchFolder& scratch, const std::string& arguments) {
  const std::string command =
      SWIVEL_PROGRAM " " + arguments + " >" + scratch.file("out") + " 2>" + scratch.file("err");
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace swivel
