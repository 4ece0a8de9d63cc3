#include "components/swivel/recorder/sample_queue.hpp"

#include <utility>

namespace swivel {

bool SampleQueue::push(RecordedSample sample) {
  const std::lock_guard lock(mutex_);
  if (bytes_ + sample.size_bytes() > most_bytes_) return false;
  bytes_ += sample.size_bytes();
  samples_.push_back(std::move(sample));
  came_.notify_one();
  return true;
}

std::optional<RecordedSample> SampleQueue::pop(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, timeout, [this] { return !samples_.empty(); })) return std::nullopt;
  std::optional<RecordedSample> sample(std::move(samples_.front()));
  samples_.pop_front();
  bytes_ -= sample->size_bytes();
  return sample;
}

}  // namespace swivel
