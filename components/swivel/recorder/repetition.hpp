// A recording that is played again and again: in each round but the first, times, sweeps and
// numbers go on where the round before ended, as if the rig had scanned the same once more. To the
// stages the very same messages would be nothing new.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "components/swivel/recorder/replay_source.hpp"

namespace swivel {

class Repetition {
 public:
  // Before each round.
  void begin_round() { ++round_; }

  // What is to be played instead. What the hardware did not send stays as it is.
  ReplayMessage next(ReplayMessage message);

 private:
  template <class Message>
  void treat(ReplayMessage& message);
  void note(std::int64_t time_ns);
  std::int64_t later(std::int64_t time_ns) const;

  void note_times(const msg::ScanLine& line);
  void note_times(const msg::Axis& axis);
  void note_times(const msg::Sweep& sweep);
  void shift(msg::ScanLine& line) const;
  void shift(msg::Axis& axis) const;
  void shift(msg::Sweep& sweep) const;

  std::uint64_t round_ = 0;
  // Of the first round:
  std::int64_t first_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  std::uint64_t last_sweep_ = 0;
  std::map<std::string, std::uint64_t> last_numbers_;  // by topic
};

}  // namespace swivel
