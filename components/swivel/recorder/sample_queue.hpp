// Samples on their way from DDS to the disk, which may be slow: bounded in bytes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "components/dds/any_topic.hpp"

namespace swivel {

struct RecordedSample {
  const AnyTopic* topic = nullptr;
  std::int64_t log_time_ns = 0;  // when it came
  CdrSample sample;

  // About what it takes in memory.
  std::uint64_t size_bytes() const { return sample.cdr.size() + sizeof(RecordedSample); }
};

class SampleQueue {
 public:
  explicit SampleQueue(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  // False where it is full: the sample is gone, and the caller counts it.
  bool push(RecordedSample sample);
  // None when the time is over.
  std::optional<RecordedSample> pop(std::chrono::milliseconds timeout);

 private:
  const std::uint64_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<RecordedSample> samples_;
  std::uint64_t bytes_ = 0;
};

}  // namespace swivel
