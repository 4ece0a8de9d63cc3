// SCIP 2.2, the language of Hokuyo lidars (C-42-04076 for the UST-10LX; C-42-03320 for others).
//
//   request  = command [";" string] end            end = LF | CR | CR LF; at most 16 in string
//   reply    = echo LF status sum LF { text sum LF } LF
//   echo     = the request without its end
//   status   = 2 characters: 00 done, 99 a scan follows, others are refusals
//   text     = 1 to 64 characters of data, or "KEY:value;" whose sum leaves out the ";"
//   sum      = the low 6 bits of the sum of the text's bytes, + 0x30
//   data     = values of 2, 3 or 4 characters, each 6 bits + 0x30, high first; a value may
//              straddle two texts
//   scan     = reply to MD or ME with status 99: a text of 4 characters, the stamp in ms, then
//              data of 3 characters a beam (range in mm), after ME 3 more (intensity)
// Before its scans, MD or ME is acknowledged by a reply with status 00 and no text.
//
// This header: the words. scip_parser.hpp: bytes to replies. scip_replies.hpp: what they mean.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace swivel::scip {

inline constexpr std::size_t kLongestText = 64;
inline constexpr std::uint32_t kStampMask = 0xFFFFFF;  // stamps are 24 bits and wrap

char checksum(std::string_view text);

// `characters` is 2, 3 or 4; the value must fit in 6 bits of each.
void append_value(std::string& data, std::uint32_t value, int characters);
std::string encode_value(std::uint32_t value, int characters);
// Nothing when a character is outside 0x30 .. 0x6F.
std::optional<std::uint32_t> decode_value(std::string_view characters);

// What a sensor writes: a text with its sum and LF; data in texts of at most 64 characters;
// KEY:value; with the sum that leaves out the semicolon.
void append_text(std::string& reply, std::string_view text);
void append_data(std::string& reply, std::string_view data);
void append_key(std::string& reply, std::string_view key, std::string_view value);

enum class Measurement { kRanges, kRangesAndIntensities };

// MD or ME, over all steps from first to last; `scans` 0 is endless. Without LF.
std::string scan_request(Measurement measurement, int first_step, int last_step, int scans = 0);

// A reply's status in words, with its two characters. Where the vendor's documents and other
// drivers disagree, both readings.
std::string status_in_words(std::string_view command, std::string_view status);

}  // namespace swivel::scip
