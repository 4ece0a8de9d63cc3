// The sweeps of one request, or of all, as they come over DDS, each with its attitude and both
// clouds.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "components/common/sweep_requester.hpp"
#include "components/dds/participant.hpp"
#include "components/swivel/offline/processed_sweep.hpp"

namespace swivel {

class LiveSweeps {
 public:
  // Subscribes: before participant.start().
  explicit LiveSweeps(Participant& participant);

  // From now on those of every request are told, and none is refused.
  void follow_all();

  // Until the sequencer has nothing to do; false when the time is over.
  bool await_idle(std::chrono::milliseconds timeout);

  void request(int mode, int count, msg::SweepSequence action_sequence);
  void cancel();

  // What happened next: a sweep that is ready, news of its progress, or the request's end.
  struct News {
    std::optional<ProcessedSweep> sweep;
    std::string progress;  // of the sweep under way, for a person
    std::string refusal;   // the request came to nothing: why
  };
  // None when the time is over.
  std::optional<News> wait(std::chrono::milliseconds timeout);

 private:
  void take(const msg::Sweep& sweep);
  void take_cloud(const PointCloud2& message, OrganisedCloud ProcessedSweep::*cloud);
  void take_assembled(const msg::Sweep& sweep);
  struct Parts {
    ProcessedSweep sweep;
    bool assembled = false;
    bool attitude = false;
  };

  Parts& parts_at(std::int64_t stamp_ns);
  void hand_out_if_whole(std::int64_t stamp_ns);
  void tell(News news);

  Writer<msg::SweepRequest> requests_;
  std::mutex mutex_;  // of what follows
  std::condition_variable came_;
  SweepRequester requester_;
  std::map<std::int64_t, Parts> parts_;  // by stamp
  std::deque<News> news_;
  std::size_t next_index_ = 0;
  bool idle_ = false;
  bool follows_all_ = false;
};

}  // namespace swivel
