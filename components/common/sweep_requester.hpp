// Asks the sequencer for sweeps. The topic is volatile, so that no request comes back to a
// sequencer that starts later; hence a request is repeated until it is answered, and its id
// makes the repetitions one request.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "swivel/idl/swivel.h"

namespace swivel {

// Not 0, and not that of another program.
std::uint64_t new_request_id();

class SweepRequester {
 public:
  using Send = std::function<void(const msg::SweepRequest&)>;
  explicit SweepRequester(Send send) : send_(std::move(send)) {}

  void request(std::uint64_t request_id, int mode, int count,
               msg::SweepSequence action_sequence = msg::SEQUENCE_IMPROVED);
  void cancel();
  // It is not repeated any more: a sequencer that starts later must not take it.
  void forget() { request_ = {}; }

  // Every Sweep on the topic; true if it belongs to the request.
  bool saw(const msg::Sweep& sweep);

  // To be called every second or so. False when nobody has answered for too long.
  bool check(std::chrono::steady_clock::time_point now);

  bool answered() const { return answered_; }

 private:
  Send send_;
  msg::SweepRequest request_;
  bool answered_ = false;
  bool asked_ = false;
  std::chrono::steady_clock::time_point asked_since_{};
};

}  // namespace swivel
