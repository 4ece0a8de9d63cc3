// SCIP as an independent client sees it: nothing here is taken from hardware/lidar.
#pragma once

#include <string>
#include <vector>

namespace swivel::sim {

// "Add the bytes of the line, keep the low 6 bits, add 0x30."
inline char sum_of(const std::string& text) {
  unsigned sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  return static_cast<char>((sum & 0x3FU) + 0x30U);
}

inline std::vector<std::string> lines_of(const std::string& reply) {
  std::vector<std::string> lines;
  std::size_t from = 0;
  for (std::size_t end = reply.find('\n'); end != std::string::npos; end = reply.find('\n', from)) {
    lines.push_back(reply.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

// Of every line but the echo; with or without the semicolon, as the vendor's library does it.
inline bool sums_hold(const std::string& reply, bool strict) {
  const auto lines = lines_of(reply);
  if (lines.size() < 3 || !lines.back().empty()) return false;
  const std::string& echo = lines.front();
  const bool has_keys = echo == "VV" || echo == "PP" || echo == "II";
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (line.size() < 2) return false;
    const bool key = has_keys && line[line.size() - 2] == ';';
    const std::string text = line.substr(0, line.size() - (key ? 2 : 1));
    const bool lenient = !strict && sum_of(line.substr(0, line.size() - 1)) == line.back();
    if (sum_of(text) != line.back() && !lenient) return false;
  }
  return true;
}

inline unsigned value_of(const std::string& characters) {
  unsigned value = 0;
  for (const char c : characters) value = (value << 6U) | (static_cast<unsigned>(c) - 0x30U);
  return value;
}

// Every `characters` of the data of a scan, sums and line ends left out.
inline std::vector<unsigned> values_of(const std::string& reply, std::size_t characters) {
  const auto lines = lines_of(reply);
  std::string data;
  for (std::size_t i = 3; i + 1 < lines.size(); ++i)
    data += lines[i].substr(0, lines[i].size() - 1);
  std::vector<unsigned> values;
  for (std::size_t i = 0; i + characters <= data.size(); i += characters) {
    values.push_back(value_of(data.substr(i, characters)));
  }
  return values;
}

}  // namespace swivel::sim
