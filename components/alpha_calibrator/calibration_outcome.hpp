// What a calibration run says, whatever it looks for.
#pragma once

#include <optional>
#include <string>

#include "swivel/idl/swivel.h"

namespace swivel {

struct LidarName {
  std::string serial_number;
  std::string firmware;
};

// Of one sweep: in words why it is left out, or what it brought.
struct CalibrationAdded {
  bool used;
  std::string words;
};

struct CalibrationOutcome {
  std::optional<msg::Calibration> calibration;
  std::string words;  // of the result, or why it was refused
};

}  // namespace swivel
