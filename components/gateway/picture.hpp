// What the page shows, and how far it is to be trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "swivel/idl/swivel.h"

namespace swivel {

struct Picture {
  enum class Kind {
    kNone,
    kRunning,    // a sweep, line by line, in frame O'
    kAssembled,  // all its lines are in; the cloud has not come yet
    kStopped,    // it came to nothing
    kCloud       // as attitude_corrector sent it
  };

  Kind kind = Kind::kNone;
  std::uint32_t number = 0;  // grows from picture to picture
  std::uint64_t sweep_id = 0;
  int mode = 0;
  std::size_t lines = 0;
  std::size_t beams = 0;
  std::size_t lines_in = 0;

  // Of a cloud:
  std::int64_t stamp_ns = 0;
  bool in_base = false;                   // as its frame says
  std::optional<msg::Attitude> attitude;  // of the same stamp
  std::string stopped;                    // why it must not be used, or came to nothing
};

struct Trust {
  enum class Level { kNothing, kRunning, kWaiting, kGood, kBad };
  Level level = Level::kNothing;
  std::string headline;
  std::string reason;
};

// Good is only a cloud in the base, all its lines in, with an attitude that says so of it.
Trust trust_in(const Picture& picture);

const char* word_for(Picture::Kind kind);
const char* word_for(Trust::Level level);

}  // namespace swivel
