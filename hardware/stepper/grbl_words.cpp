// What GRBL's codes mean to the owner of a rotating lidar.
#include <array>

#include "hardware/stepper/grbl.hpp"

namespace swivel {
namespace {

struct CodeWords {
  int code;
  const char* words;
};

constexpr std::array<CodeWords, 18> kErrors{{
    {1, "the line does not begin with a letter; is the serial line noisy?"},
    {2, "a number could not be read; is the serial line noisy?"},
    {3, "it does not know this $ command; is it GRBL 1.1?"},
    {4, "a value must not be negative"},
    {5, "homing is switched off; send $22=1"},
    {6, "the step pulse ($0) must be 3 us or longer"},
    {7, "its stored settings could not be read and went back to their defaults; set them again"},
    {8, "it takes this only when it stands still"},
    {9, "it is locked after an alarm or a reset; home it first"},
    {10, "soft limits ($20) need homing ($22=1)"},
    {11, "the line was too long"},
    {12, "the step rate would pass 30 kHz; lower $110 or $100"},
    {13, "its safety door input is open; check the wiring"},
    {14, "its build information is too long"},
    {15, "the turn would pass its travel; raise $130 or ask for less"},
    {16, "it does not take this as a jog; is it GRBL 1.1?"},
    {17, "laser mode needs a PWM output; send $32=0"},
    {22, "the speed is missing"},
}};

constexpr std::array<CodeWords, 10> kAlarms{{
    {1, "the limit switch closed during a turn; free the shaft, then home"},
    {2, "the turn would pass its travel ($130); it stopped, its position is kept"},
    {3, "it was reset while turning, so its position is lost; home it"},
    {4, "the probe is not in its expected state"},
    {5, "the probe was not found"},
    {6, "homing was stopped by a reset"},
    {7, "homing was stopped by the safety door input"},
    {8, "homing could not leave the switch again; raise the pull-off ($27) or check the switch"},
    {9,
     "homing did not find the home switch; check its wiring and that it is powered, the "
     "direction ($23), the travel ($130), and that the shaft turns freely"},
    {10, "homing of a second motor failed; this build is for another machine"},
}};

template <std::size_t count>
const char* words_for(const std::array<CodeWords, count>& table, int code, const char* otherwise) {
  for (const CodeWords& entry : table) {
    if (entry.code == code) return entry.words;
  }
  return otherwise;
}

}  // namespace

std::string grbl_error_words(int code) {
  return "error:" + std::to_string(code) + ": " +
         words_for(kErrors, code, "it did not understand the line; is it GRBL 1.1?");
}

std::string grbl_alarm_words(int code) {
  return "ALARM:" + std::to_string(code) + ": " +
         words_for(kAlarms, code, "unknown to GRBL 1.1; reset it and home");
}

}  // namespace swivel
