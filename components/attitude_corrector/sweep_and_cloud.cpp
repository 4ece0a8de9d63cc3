#include "components/attitude_corrector/sweep_and_cloud.hpp"

#include <algorithm>

#include "components/common/cloud_message.hpp"

namespace swivel {
namespace {

constexpr std::size_t kMostWaiting = 16;

}  // namespace

bool SweepAndCloud::add(const msg::Sweep& assembled) {
  if (assembled.lines_used() == 0) {
    take_back(assembled);
    return false;
  }
  if (assembled.first_beam_time_ns() == 0) return false;
  waiting_.push_back(assembled);
  if (waiting_.size() > kMostWaiting) {
    waiting_.pop_front();
    ++sweeps_without_cloud_;
  }
  match();
  return complete();
}

std::string SweepAndCloud::add(const PointCloud2Message& message) {
  if (cloud_stamp_ns_ && !sweep_) ++clouds_refused_;  // the one before never got its sweep
  cloud_stamp_ns_.reset();
  std::string wrong = from_message(message, cloud_);
  if (!wrong.empty()) {
    ++clouds_refused_;
    return wrong;
  }
  cloud_stamp_ns_ = stamp_ns(message);
  match();
  return {};
}

// Of a sweep that turned out to be none; its cloud, should it come, is refused.
void SweepAndCloud::take_back(const msg::Sweep& assembled) {
  const auto gone = std::remove_if(waiting_.begin(), waiting_.end(), [&](const msg::Sweep& sweep) {
    return sweep.sweep_id() == assembled.sweep_id();
  });
  sweeps_without_cloud_ += static_cast<std::uint64_t>(waiting_.end() - gone);
  waiting_.erase(gone, waiting_.end());
}

void SweepAndCloud::match() {
  if (!cloud_stamp_ns_) return;
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const msg::Sweep& sweep) {
    return sweep.first_beam_time_ns() == *cloud_stamp_ns_;
  });
  if (found == waiting_.end()) return;
  sweep_ = *found;
  sweeps_without_cloud_ += static_cast<std::uint64_t>(found - waiting_.begin());
  waiting_.erase(waiting_.begin(), found + 1);
}

void SweepAndCloud::clear() {
  sweep_.reset();
  cloud_stamp_ns_.reset();
}

}  // namespace swivel
