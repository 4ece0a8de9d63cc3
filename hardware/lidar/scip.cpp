#include "hardware/lidar/scip.hpp"

#include <algorithm>
#include <cassert>
#include <cstdio>

namespace swivel::scip {
namespace {

constexpr int kBitsPerCharacter = 6;
constexpr std::uint32_t kLowBits = 0x3F;
constexpr char kZero = 0x30;

struct Meaning {
  std::string_view status;
  std::string_view words;
};

template <std::size_t count>
std::string_view look_up(const Meaning (&table)[count], std::string_view status) {
  for (const Meaning& meaning : table)
    if (meaning.status == status) return meaning.words;
  return {};
}

// C-42-03320 p. 11 and 14, and drivers that were tested on the sensor.
constexpr Meaning kMeasurementMeanings[] = {{"01", "the first step is not a number"},
                                            {"02", "the last step is not a number"},
                                            {"03", "the cluster is not a number"},
                                            {"04", "the last step is out of range"},
                                            {"05", "the last step precedes the first"},
                                            {"06", "the interval is not a number"},
                                            {"07", "the number of scans is not a number"},
                                            {"98", "measuring again after a check"},
                                            {"99", "a scan follows"}};
constexpr Meaning kLaserMeanings[] = {{"01", "the laser does not light: it may be out of order"},
                                      {"02", "the laser is already on"}};
constexpr Meaning kTimeMeanings[] = {{"01", "bad parameter"},
                                     {"02", "already in clock mode"},
                                     {"03", "already out of clock mode"},
                                     {"04", "not in clock mode"}};
constexpr Meaning kGeneralMeanings[] = {
    {"00", "done"},
    {"10", "denied in its present state (laser off, or measuring)"},
    {"0L", "abnormal: switch the sensor off and on"},
    {"0M", "unstable: it may still be starting, or is shaken; wait"},
    {"0B", "repeated request"},
    {"0C", "insufficient parameters"},
    {"0D", "request too long, or undefined"},
    {"0E", "undefined request"},
    {"0F", "request not supported, or insufficient parameters"},
    {"0G", "string longer than 16 characters"},
    {"0H", "request too short, or characters that are not allowed"}};

// 21 to 49 and 50 to 97 of the scans are ranges of codes.
std::string_view measurement_range(std::string_view status) {
  if (status >= "21" && status <= "49")
    return "measuring stopped: the sensor verifies an error of its own";
  if (status >= "50" && status <= "97")
    return "trouble in the sensor's hardware (laser, motor): have it repaired";
  return {};
}

std::string_view special_meaning(std::string_view command, std::string_view status) {
  const std::string_view family = command.substr(0, 2);
  if (family == "BM") return look_up(kLaserMeanings, status);
  if (family == "TM") return look_up(kTimeMeanings, status);
  if (family == "RB" && status == "01") return "ask once more within a second";
  if (family != "MD" && family != "ME" && family != "GD" && family != "GE") return {};
  const std::string_view words = look_up(kMeasurementMeanings, status);
  return words.empty() && status.find_first_not_of("0123456789") == std::string_view::npos
             ? measurement_range(status)
             : words;
}

}  // namespace

char checksum(std::string_view text) {
  std::uint32_t sum = 0;
  for (const char character : text) sum += static_cast<unsigned char>(character);
  return static_cast<char>((sum & kLowBits) + kZero);
}

void append_value(std::string& data, std::uint32_t value, int characters) {
  assert(characters >= 1 && characters <= 4 && value >> (kBitsPerCharacter * characters) == 0);
  for (int shift = kBitsPerCharacter * (characters - 1); shift >= 0; shift -= kBitsPerCharacter)
    data.push_back(static_cast<char>(((value >> shift) & kLowBits) + kZero));
}

std::string encode_value(std::uint32_t value, int characters) {
  std::string data;
  append_value(data, value, characters);
  return data;
}

std::optional<std::uint32_t> decode_value(std::string_view characters) {
  assert(!characters.empty() && characters.size() <= 4);
  std::uint32_t value = 0;
  for (const char character : characters) {
    const int bits = character - kZero;
    if (bits < 0 || bits > static_cast<int>(kLowBits)) return std::nullopt;
    value = value << kBitsPerCharacter | static_cast<std::uint32_t>(bits);
  }
  return value;
}

void append_text(std::string& reply, std::string_view text) {
  reply.append(text).push_back(checksum(text));
  reply.push_back('\n');
}

void append_data(std::string& reply, std::string_view data) {
  for (; !data.empty(); data.remove_prefix(std::min(kLongestText, data.size())))
    append_text(reply, data.substr(0, kLongestText));
}

void append_key(std::string& reply, std::string_view key, std::string_view value) {
  const std::size_t start = reply.size();
  reply.append(key).append(":").append(value);
  const char sum = checksum(std::string_view(reply).substr(start));
  reply.append(";").push_back(sum);
  reply.push_back('\n');
}

std::string scan_request(Measurement measurement, int first_step, int last_step, int scans) {
  assert(first_step >= 0 && first_step <= last_step && last_step <= 9999);
  assert(scans >= 0 && scans <= 99);
  char request[64];
  std::snprintf(request, sizeof(request), "%s%04d%04d010%02d",
                measurement == Measurement::kRanges ? "MD" : "ME", first_step, last_step, scans);
  return request;
}

std::string status_in_words(std::string_view command, std::string_view status) {
  std::string_view words = special_meaning(command, status);
  if (words.empty()) words = look_up(kGeneralMeanings, status);
  if (words.empty()) words = "unknown";
  return "status " + std::string(status) + ": " + std::string(words);
}

}  // namespace swivel::scip
