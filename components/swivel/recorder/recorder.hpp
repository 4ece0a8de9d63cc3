// Records topics as they come, byte for byte. What comes goes through a bounded queue to a thread
// of its own, since bringing it to the disk may take long.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/mcap/sequence_count.hpp"
#include "components/swivel/recorder/recording_files.hpp"
#include "components/swivel/recorder/sample_queue.hpp"

namespace swivel {

struct RecorderOptions {
  std::string path;
  RecordingLimits limits;
  // Not all is written, but what came in so many last seconds when a trigger comes.
  std::optional<std::chrono::seconds> last;
  std::uint64_t queue_bytes = 256 << 20;
  std::uint64_t last_bytes = 1 << 30;  // kept at most, whatever `last` says
};

struct TopicCount {
  std::uint64_t messages = 0;  // that came
  std::uint64_t bytes = 0;
  std::uint64_t lost = 0;     // on their way to here
  std::uint64_t dropped = 0;  // the disk was too slow, or recording had failed
};

struct RecorderSummary {
  std::map<std::string, TopicCount> topics;  // by full name
  std::vector<std::string> files;
  std::string failure;  // why it ended early; else empty

  TopicCount total() const;
};

class Recorder {
 public:
  // Subscribes: before participant.start(). Throws ExitError where the file cannot be made.
  Recorder(Participant& participant, const std::vector<AnyTopic>& topics, RecorderOptions options);
  ~Recorder();

  void trigger() { triggered_ = true; }
  bool failed() const { return failed_; }
  RecorderSummary summary() const;

  // After participant.stop(): writes what is left, and closes the file.
  RecorderSummary finish();

 private:
  void take(const AnyTopic& topic, CdrSample&& sample);
  void run();
  Outcome work(std::optional<RecordedSample> sample);
  void keep(RecordedSample sample);
  Outcome write_kept();
  void count_not_safe();
  void fail(const std::string& reason);

  const RecorderOptions options_;
  const std::string rig_;
  const std::vector<AnyTopic> topics_;
  SampleQueue queue_;
  std::atomic<bool> triggered_{false};
  std::atomic<bool> finishing_{false};
  std::atomic<bool> failed_{false};

  mutable std::mutex mutex_;  // of what follows
  std::map<std::string, TopicCount> counts_;
  std::map<std::pair<const AnyTopic*, std::string>, SequenceCount> sequences_;
  std::string failure_;

  // The writing thread's:
  RecordingFiles files_;
  std::deque<RecordedSample> kept_;
  std::uint64_t kept_bytes_ = 0;
  // The last calibration stands however old it is.
  std::map<std::string, RecordedSample> calibrations_;
  std::thread thread_;
};

}  // namespace swivel
