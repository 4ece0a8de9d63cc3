#include "components/swivel/recorder/recorder.hpp"

#include "components/common/program.hpp"
#include "components/log/log.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

constexpr auto kLongestPause = std::chrono::milliseconds(100);

}  // namespace

TopicCount RecorderSummary::total() const {
  TopicCount sum;
  for (const auto& [name, count] : topics) {
    sum.messages += count.messages;
    sum.bytes += count.bytes;
    sum.lost += count.lost;
    sum.dropped += count.dropped;
  }
  return sum;
}

Recorder::Recorder(Participant& participant, const std::vector<AnyTopic>& topics,
                   RecorderOptions options)
    : options_(std::move(options)),
      rig_(participant.rig()),
      topics_(topics),
      queue_(options_.queue_bytes),
      files_(options_.path, rig_, options_.limits) {
  if (!options_.last) {
    if (const Outcome opened = files_.open(); !opened) {
      throw ExitError(kExitCannotWrite, opened.reason());
    }
  }
  for (const AnyTopic& topic : topics_) {
    participant.subscribe_cdr(
        topic, [this, &topic](CdrSample&& sample) { take(topic, std::move(sample)); });
  }
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
  finish();
}

// On the participant's thread: must not wait for the disk.
void Recorder::take(const AnyTopic& topic, CdrSample&& sample) {
  const std::lock_guard lock(mutex_);
  TopicCount& count = counts_[topic.full_name(rig_)];
  SequenceCount& sequence = sequences_[{&topic, sample.writer}];
  const std::uint64_t missing_before = sequence.missing();
  sequence.add(static_cast<std::uint32_t>(sample.number));
  count.lost += sequence.missing() - missing_before;
  ++count.messages;
  count.bytes += sample.cdr.size();
  if (!failed_ && queue_.push({&topic, now_ns(), std::move(sample)})) return;
  if (++count.dropped == 1 && !failed_) {
    log_error("the disk is too slow: messages of {} are lost", topic.full_name(rig_));
  }
}

void Recorder::run() {
  while (!failed_) {
    auto sample = queue_.pop(kLongestPause);
    const bool done = !sample && finishing_;
    if (const Outcome worked = work(std::move(sample)); !worked) fail(worked.reason());
    if (done) break;
  }
  if (const Outcome closed = files_.close(); !closed) fail(closed.reason());
  count_not_safe();
}

// What a failure left between memory and disk was counted as come, but is in no file.
void Recorder::count_not_safe() {
  const std::lock_guard lock(mutex_);
  for (const auto& [topic, count] : files_.not_safe()) {
    counts_[topic->full_name(rig_)].dropped += count;
  }
}

Outcome Recorder::work(std::optional<RecordedSample> sample) {
  if (sample && options_.last) {
    keep(std::move(*sample));
  } else if (sample) {
    if (Outcome written = files_.write(*sample); !written) return written;
  }
  if (triggered_.exchange(false) && options_.last) {
    if (Outcome written = write_kept(); !written) return written;
  }
  return files_.keep_safe();
}

void Recorder::keep(RecordedSample sample) {
  const std::int64_t oldest_ns =
      sample.log_time_ns - std::chrono::nanoseconds(*options_.last).count();
  kept_bytes_ += sample.size_bytes();
  kept_.push_back(std::move(sample));
  while (!kept_.empty() &&
         (kept_.front().log_time_ns < oldest_ns || kept_bytes_ > options_.last_bytes)) {
    RecordedSample& oldest = kept_.front();
    kept_bytes_ -= oldest.size_bytes();
    if (oldest.topic->is(kCalibrationTopic)) {
      calibrations_[oldest.sample.writer] = std::move(oldest);
    }
    kept_.pop_front();
  }
}

Outcome Recorder::write_kept() {
  if (Outcome opened = files_.open(); !opened) return opened;
  for (const auto& [writer, calibration] : calibrations_) {
    if (Outcome written = files_.write(calibration); !written) return written;
  }
  for (const RecordedSample& sample : kept_) {
    if (Outcome written = files_.write(sample); !written) return written;
  }
  log_info("the last {} messages are in {}", kept_.size(), files_.names().back());
  return files_.close();
}

void Recorder::fail(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (failure_.empty()) failure_ = reason;
  failed_ = true;
}

RecorderSummary Recorder::summary() const {
  const std::lock_guard lock(mutex_);
  return {counts_, {}, failure_};
}

RecorderSummary Recorder::finish() {
  finishing_ = true;
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  // What a failure left in the queue was counted as come, but is in no file.
  while (const auto left = queue_.pop(std::chrono::milliseconds(0))) {
    ++counts_[left->topic->full_name(rig_)].dropped;
  }
  return {counts_, files_.names(), failure_};
}

}  // namespace swivel
