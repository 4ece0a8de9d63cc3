// What the doctor found out about one thing.
#pragma once

#include <string>

namespace swivel {

enum class Grade {
  kOk,
  kWarn,  // it works, but not as well as it could, or not for everything
  kBad    // a scan would fail
};

struct Diagnosis {
  std::string subject;  // "lidar"
  Grade grade = Grade::kOk;
  std::string words;   // what was found
  std::string advice;  // what to do about it; empty where all is well
};

}  // namespace swivel
