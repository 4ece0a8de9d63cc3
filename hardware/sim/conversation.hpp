// A captured connection with a device: what was asked, and what came of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace swivel::sim {

// A piece of a connection, as the capture has it.
struct CapturedPiece {
  enum class Kind { kToDevice, kFromDevice, kHungUp };
  Kind kind = Kind::kToDevice;
  std::int64_t time_ns = 0;
  std::uint64_t offset = 0;  // among the bytes that went the same way
  std::string bytes;
};

struct Answer {
  std::int64_t delay_ns = 0;  // after the request
  std::string bytes;          // empty: the device hangs up
  std::int64_t time_ns = 0;   // as captured
};

struct Exchange {
  std::string request;  // with its line end; empty: the connection was opened
  std::vector<Answer> answers;
  std::int64_t time_ns = 0;  // of the request, as captured
};

struct Conversation {
  std::vector<Exchange> exchanges;   // the first is the opening
  std::uint64_t bytes_missing = 0;   // holes in the capture, either way
  std::uint64_t bytes_left_out = 0;  // streamed before a long hole
};

// Takes the next request from the front of `bytes`: up to a line's end, or one of the characters
// that a device acts on at once. Empty if none is whole.
std::string take_request(std::string& bytes, const std::string& at_once);

// Pieces in order of time. What comes twice is taken once. A long hole is closed, since who waits
// for what was in it would hang up: the stream begins after it.
Conversation conversation_of(const std::vector<CapturedPiece>& pieces, std::int64_t opened_ns,
                             const std::string& at_once);

}  // namespace swivel::sim
