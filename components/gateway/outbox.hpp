// What waits for one client, bounded: a client that does not keep up loses the oldest, and the
// loss is counted. Nobody waits for a slow client.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "components/gateway/frame.hpp"

namespace swivel {

class Outbox {
 public:
  explicit Outbox(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // A single frame is always taken, however large. Returns how many were dropped for it.
  std::size_t push(Frame frame);
  std::optional<Frame> pop();

  // True once after frames were dropped and the rest has gone: time to be told all anew.
  bool take_lag();

  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::deque<Frame> frames_;
  bool lags_ = false;
};

}  // namespace swivel
