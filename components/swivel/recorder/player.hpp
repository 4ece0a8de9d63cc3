// Publishes a recording's messages, as fast as the readers can follow.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/dds/any_topic.hpp"
#include "components/swivel/recorder/replay_source.hpp"

namespace swivel {

class Player {
 public:
  // Before participant.start().
  Player(Participant& participant, const std::vector<AnyTopic>& topics);

  // Of the scan lines and sweeps, if those are played, else of anything.
  bool has_readers() const;

  void play(const ReplayMessage& message);
  // Until all is taken and the last sweep is through the stages.
  void finish();

  std::uint64_t played() const;
  std::string in_words() const;

 private:
  struct Output {
    std::unique_ptr<CdrWriter> writer;
    std::uint64_t written = 0;
    std::uint64_t refused = 0;
  };

  void send(const ReplayMessage& message);
  void play_sweep(const ReplayMessage& message);
  void await_stages();
  std::size_t readers_of(const std::string& topic) const;

  std::map<std::string, Output> outputs_;  // by the topic's name
  std::uint64_t sweep_ = 0;                // under way in the stages
  std::int64_t window_end_ns_ = 0;         // its last
  bool over_ = false;                      // its end is told
  bool has_corrector_ = true;              // until an attitude does not come
  std::atomic<std::uint64_t> last_assembled_{0};
  std::atomic<std::uint64_t> last_corrected_{0};
  std::atomic<bool> last_has_cloud_{false};
};

}  // namespace swivel
