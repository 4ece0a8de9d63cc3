#include "components/gateway/outbox.hpp"

#include <utility>

namespace swivel {

std::size_t Outbox::push(Frame frame) {
  std::size_t dropped = 0;
  while (!frames_.empty() && bytes_ + frame.bytes() > most_bytes_) {
    pop();
    ++dropped;
  }
  lags_ = lags_ || dropped > 0;
  bytes_ += frame.bytes();
  frames_.push_back(std::move(frame));
  return dropped;
}

std::optional<Frame> Outbox::pop() {
  if (frames_.empty()) return std::nullopt;
  Frame frame = std::move(frames_.front());
  frames_.pop_front();
  bytes_ -= frame.bytes();
  return frame;
}

bool Outbox::take_lag() {
  return frames_.empty() && std::exchange(lags_, false);
}

}  // namespace swivel
