#include "hardware/sim/grbl_words.hpp"

#include <cctype>
#include <cmath>
#include <string>

namespace swivel::sim {
namespace {

GrblError take_g_word(double number, GrblWords& words) {
  if (number < 0.0 || number > 1000.0) return kUnsupported;
  const int tenths = static_cast<int>(std::lround(number * 10.0));
  switch (tenths) {
    case 0:
      words.motion = 0;
      return kNoError;
    case 10:
      words.motion = 1;
      return kNoError;
    case 200:
      words.inches = true;
      return kNoError;
    case 530:
      words.machine_coordinates = true;
      return kNoError;
    case 900:
      words.absolute = true;
      return kNoError;
    case 910:
      words.absolute = false;
      return kNoError;
    case 170:
    case 210:
    case 540:
    case 940:
      return kNoError;  // what this axis is in anyway
    default:
      return kUnsupported;
  }
}

GrblError take_word(char letter, double number, GrblWords& words) {
  switch (letter) {
    case 'G':
      return take_g_word(number, words);
    case 'X':
      words.x = number;
      return kNoError;
    case 'Y':
      words.y = number;
      return kNoError;
    case 'Z':
      words.z = number;
      return kNoError;
    case 'F':
      if (number < 0.0) return kBadNumber;
      words.feed_per_min = number;
      return kNoError;
    case 'N':
    case 'S':
    case 'T':
      return kNoError;
    case 'M':
      return number == 5.0 || number == 9.0 ? kNoError : kUnsupported;
    default:
      return kUnsupported;
  }
}

std::string without_blanks(std::string_view text) {
  std::string packed;
  for (const char c : text) {
    if (c != ' ') packed += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return packed;
}

}  // namespace

std::optional<double> take_grbl_number(std::string_view& text) {
  std::string digits;
  bool any_digit = false;
  while (!text.empty()) {
    const char c = text.front();
    const bool sign = (c == '-' || c == '+') && digits.empty();
    const bool point = c == '.' && digits.find('.') == std::string::npos;
    const bool digit = c >= '0' && c <= '9';
    if (!sign && !point && !digit) break;
    any_digit = any_digit || digit;
    digits += c;
    text.remove_prefix(1);
  }
  if (!any_digit || digits.size() > 20) return std::nullopt;
  return std::stod(digits);
}

GrblWords parse_grbl_words(std::string_view text) {
  const std::string packed = without_blanks(text);
  std::string_view rest = packed;
  GrblWords words;
  while (!rest.empty() && words.error == kNoError) {
    const char letter = rest.front();
    rest.remove_prefix(1);
    if (letter < 'A' || letter > 'Z') {
      words.error = kExpectedLetter;
    } else if (const auto number = take_grbl_number(rest)) {
      words.error = take_word(letter, *number, words);
    } else {
      words.error = kBadNumber;
    }
  }
  return words;
}

}  // namespace swivel::sim
