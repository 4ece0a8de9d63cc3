// A line of G-code or a jog, as far as one axis needs it.
#pragma once

#include <optional>
#include <string_view>

namespace swivel::sim {

enum GrblError {
  kNoError = 0,
  kExpectedLetter = 1,
  kBadNumber = 2,
  kUnknownCommand = 3,
  kHomingDisabled = 5,
  kNotIdle = 8,
  kLocked = 9,
  kLineTooLong = 11,
  kBeyondTravel = 15,
  kInvalidJog = 16,
  kUnsupported = 20,
  kNoFeed = 22,
  kNoAxis = 26,
  kUnusedWord = 36
};

struct GrblWords {
  GrblError error = kNoError;
  std::optional<int> motion;         // 0 for G0, 1 for G1
  std::optional<bool> absolute;      // G90, G91
  bool machine_coordinates = false;  // G53
  bool inches = false;               // G20
  std::optional<double> x, y, z;     // the unit of X is a degree
  std::optional<double> feed_per_min;

  bool any_axis() const { return x || y || z; }
};

// `text` without the "$J=" of a jog. Blanks do not matter, nor do capitals.
GrblWords parse_grbl_words(std::string_view text);

// The number that `text` begins with, cut off from it; nothing when it does not begin with one.
std::optional<double> take_grbl_number(std::string_view& text);

}  // namespace swivel::sim
