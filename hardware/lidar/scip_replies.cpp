#include "hardware/lidar/scip_replies.hpp"

#include <algorithm>
#include <charconv>
#include <map>

namespace swivel::scip {
namespace {

constexpr std::size_t kStampCharacters = 4;
constexpr std::size_t kValueCharacters = 3;
constexpr std::uint32_t kLargest = 65535;
constexpr int kLargestStep = 9999;              // requests have four digits
constexpr std::uint16_t kLargestRange = 65532;  // above it stand codes

using Keys = std::map<std::string, std::string, std::less<>>;

Keys keys_of(const Reply& reply) {
  Keys keys;
  for (std::size_t which = 0; which < reply.text_count(); ++which) {
    std::string_view text = reply.text(which);
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) continue;
    if (text.back() == ';') text.remove_suffix(1);
    keys[std::string(text.substr(0, colon))] = std::string(text.substr(colon + 1));
  }
  return keys;
}

std::string value_of(const Keys& keys, std::string_view key) {
  const auto found = keys.find(key);
  return found == keys.end() ? std::string() : found->second;
}

// Takes whole numbers out of keys and remembers the first one that is missing or unlikely.
class NumberReader {
 public:
  explicit NumberReader(const Keys& keys) : keys_(keys) {}

  int number(std::string_view key, int smallest, int largest) {
    const std::string text = value_of(keys_, key);
    int value = 0;
    const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_good = error == std::errc{} && value >= smallest && value <= largest;
    if (!is_good && complaint_.empty())
      complaint_ = std::string(key) + (text.empty() ? " is missing" : " is '" + text + "'");
    return is_good ? value : smallest;
  }
  const std::string& complaint() const { return complaint_; }

 private:
  const Keys& keys_;
  std::string complaint_;
};

Failure unusable(std::string_view command, const std::string& why) {
  return Failure{"the sensor's answer to " + std::string(command) + " cannot be used: " + why};
}

// The documents name the direction's values, not its key.
bool says_clockwise(const Keys& keys) {
  return std::any_of(keys.begin(), keys.end(), [](const auto& key) { return key.second == "CW"; });
}

// Four characters of six bits, or, in some firmware, six hexadecimal digits.
std::optional<std::uint32_t> state_stamp(const std::string& text) {
  if (text.size() == kStampCharacters) return decode_value(text);
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value, 16);
  if (text.size() != 6 || error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

Result<std::uint32_t> decode_stamp(const Reply& reply) {
  if (reply.text_count() == 0) return Failure{"the time stamp is missing"};
  const std::string_view text = reply.text(0);
  if (text.size() != kStampCharacters)
    return Failure{"the time stamp has " + std::to_string(text.size()) +
                   " characters instead of 4: this is not SCIP 2.2"};
  const std::optional<std::uint32_t> stamp = decode_value(text);
  if (!stamp) return Failure{"the time stamp has characters that are not allowed"};
  return *stamp;
}

// 65535 for what does not fit, or -1 for characters that are not allowed.
int decode_beam(std::string_view characters, std::size_t& saturated) {
  const std::optional<std::uint32_t> value = decode_value(characters);
  if (!value) return -1;
  if (*value > kLargest) ++saturated;
  return static_cast<int>(std::min(*value, kLargest));
}

bool decode_beams(std::string_view data, bool has_intensities, Scan& scan) {
  while (!data.empty()) {
    const int range_mm = decode_beam(data.substr(0, kValueCharacters), scan.saturated);
    if (range_mm < 0) return false;
    scan.ranges_mm.push_back(static_cast<std::uint16_t>(range_mm));
    data.remove_prefix(kValueCharacters);
    if (!has_intensities) continue;
    const int intensity = decode_beam(data.substr(0, kValueCharacters), scan.saturated);
    if (intensity < 0) return false;
    scan.intensities.push_back(static_cast<std::uint16_t>(intensity));
    data.remove_prefix(kValueCharacters);
  }
  return true;
}

}  // namespace

Result<LidarIdentity> decode_identity(const Reply& reply) {
  const Keys keys = keys_of(reply);
  for (const char* const demanded : {"PROD", "FIRM", "SERI"})
    if (value_of(keys, demanded).empty())
      return unusable("VV", demanded + std::string(" is missing"));
  return LidarIdentity{value_of(keys, "VEND"), value_of(keys, "PROD"), value_of(keys, "FIRM"),
                       value_of(keys, "PROT"), value_of(keys, "SERI")};
}

Result<Parameters> decode_parameters(const Reply& reply) {
  const Keys keys = keys_of(reply);
  NumberReader reader(keys);
  Parameters read;
  read.model = value_of(keys, "MODL");
  read.range_min_mm = static_cast<std::uint16_t>(reader.number("DMIN", 0, kLargestRange));
  read.range_max_mm = static_cast<std::uint16_t>(
      std::min<int>(reader.number("DMAX", 1, 10'000'000), kLargestRange));
  read.steps_per_turn = reader.number("ARES", 1, kLargestStep + 1);
  read.first_step = reader.number("AMIN", 0, kLargestStep);
  read.last_step = reader.number("AMAX", read.first_step, kLargestStep);
  read.front_step = reader.number("AFRT", 0, kLargestStep);
  read.speed_rpm = reader.number("SCAN", 1, 60'000);
  read.clockwise = says_clockwise(keys);
  if (!reader.complaint().empty()) return unusable("PP", reader.complaint());
  if (read.beams() > read.steps_per_turn) return unusable("PP", "more beams than steps in a turn");
  if (read.range_min_mm >= read.range_max_mm) return unusable("PP", "DMIN is not below DMAX");
  return read;
}

Result<State> decode_state(const Reply& reply) {
  const Keys keys = keys_of(reply);
  if (value_of(keys, "STAT").empty()) return unusable("II", "STAT is missing");
  return State{value_of(keys, "LASR"), value_of(keys, "MESM"), state_stamp(value_of(keys, "TIME")),
               value_of(keys, "STAT")};
}

Result<std::uint32_t> decode_clock(const Reply& reply) {
  Result<std::uint32_t> stamp = decode_stamp(reply);
  if (stamp && reply.text_count() != 1) return unusable("TM1", "more than a time stamp");
  return stamp ? stamp : unusable("TM1", stamp.reason());
}

Result<Scan> decode_scan(const Reply& reply, Measurement measurement, int beams) {
  const Result<std::uint32_t> stamp = decode_stamp(reply);
  if (!stamp) return Failure{stamp.reason()};
  const bool has_intensities = measurement == Measurement::kRangesAndIntensities;
  const std::string_view data = reply.texts_from(1);
  const std::size_t characters_a_beam = kValueCharacters * (has_intensities ? 2 : 1);
  if (data.size() != characters_a_beam * static_cast<std::size_t>(beams))
    return Failure{"a scan has " + std::to_string(data.size() / characters_a_beam) + " points (" +
                   std::to_string(data.size()) + " characters) instead of " +
                   std::to_string(beams)};
  Scan scan;
  scan.stamp_ms = *stamp;
  scan.ranges_mm.reserve(static_cast<std::size_t>(beams));
  if (has_intensities) scan.intensities.reserve(static_cast<std::size_t>(beams));
  if (!decode_beams(data, has_intensities, scan))
    return Failure{"a scan has characters that are not allowed"};
  return scan;
}

}  // namespace swivel::scip
