#include "components/common/sweep_requester.hpp"

#include <random>

namespace swivel {
namespace {

constexpr auto kPatience = std::chrono::seconds(10);

}  // namespace

std::uint64_t new_request_id() {
  std::random_device device;
  return ((std::uint64_t{device()} << 32) | device()) | 1U;
}

void SweepRequester::request(std::uint64_t request_id, int mode, int count,
                             msg::SweepSequence action_sequence) {
  request_ = {};
  request_.request_id(request_id);
  request_.mode(static_cast<std::uint8_t>(mode));
  request_.count(static_cast<std::uint16_t>(count));
  request_.action_sequence(action_sequence);
  answered_ = false;
  asked_ = false;
  send_(request_);
}

void SweepRequester::cancel() {
  msg::SweepRequest cancel = request_;
  cancel.cancel(true);
  send_(cancel);
}

bool SweepRequester::saw(const msg::Sweep& sweep) {
  const bool ours = request_.request_id() != 0 && sweep.request_id() == request_.request_id();
  answered_ = answered_ || ours;
  return ours;
}

bool SweepRequester::check(std::chrono::steady_clock::time_point now) {
  if (answered_ || request_.request_id() == 0) return true;
  if (!asked_) asked_since_ = now;
  asked_ = true;
  send_(request_);
  return now - asked_since_ < kPatience;
}

}  // namespace swivel
