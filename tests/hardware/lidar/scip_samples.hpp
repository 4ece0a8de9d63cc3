// Replies as a sensor writes them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hardware/lidar/scip.hpp"
#include "hardware/lidar/scip_parser.hpp"

namespace swivel::scip {

inline std::string reply_of(const std::string& echo, const std::string& status,
                            const std::string& texts = {}) {
  std::string reply = echo + "\n";
  append_text(reply, status);
  return reply + texts + "\n";
}

// A scan of `beams` whose beam k measures 20 k + `shift` mm, of intensity 1000 + k.
inline std::string scan_of(int beams, bool has_intensities, std::uint32_t shift = 0) {
  std::string texts;
  append_text(texts, encode_value(0x123456 + shift, 4));
  std::string data;
  for (std::uint32_t beam = 0; beam < static_cast<std::uint32_t>(beams); ++beam) {
    append_value(data, 20 * beam + shift, 3);
    if (has_intensities) append_value(data, 1000 + beam, 3);
  }
  append_data(texts, data);
  return reply_of(has_intensities ? "ME0000108001000" : "MD0000108001000", "99", texts);
}

inline std::string parameters_reply(const std::string& last_key = {},
                                    const std::string& last_value = {}) {
  std::string texts;
  append_key(texts, "MODL", "UST-10LX");
  append_key(texts, "DMIN", "20");
  append_key(texts, "DMAX", "30000");
  append_key(texts, "ARES", "1440");
  append_key(texts, "AMIN", "0");
  append_key(texts, "AMAX", "1080");
  append_key(texts, "AFRT", "540");
  append_key(texts, "SCAN", "2400");
  if (!last_key.empty()) append_key(texts, last_key, last_value);
  return reply_of("PP", "00", texts);
}

inline Reply parsed(const std::string& bytes) {
  const std::vector<Reply> replies = Parser().push(bytes);
  EXPECT_EQ(replies.size(), 1U);
  return replies.empty() ? Reply{} : replies.front();
}

}  // namespace swivel::scip
