// What a recording holds, known before its ranges are read: every line's time and axis angle,
// and which lines make a sweep. The two readers fill it in; Recording plays it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/recording/recording.hpp"
#include "hardware/result.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

// Times at the edge of an interval are given this much room, so that rounding puts none out.
inline constexpr std::int64_t kHair_ns = 1000;

// What a sensor of this family says where no echo came back (docs/protocols.md); the files say 0.
inline constexpr std::uint16_t kNoReturn = 65533;

struct RecordedLine {
  std::uint64_t sequence_number = 0;
  std::int64_t beam0_time_ns = 0;
  std::int64_t arrival_time_ns = 0;
  std::uint32_t device_stamp_ms = 0;
  // The measured axis angle at the line's first beam and at its last.
  struct Angles {
    double first_beam_deg = 0.0;
    double last_beam_deg = 0.0;
  };
  std::optional<Angles> axis;
};

struct RecordedSweep {
  std::size_t first_line = 0;  // index into RecordingPlan::lines
  std::size_t line_count = 0;  // those that are there
  std::int64_t first_beam_time_ns = 0;
  std::uint8_t mode = 0;  // 0: none of the seven
  msg::SweepSequence action_sequence = msg::SEQUENCE_IMPROVED;
  double speed_deg_s = 0.0;
  std::uint32_t lines_expected = 0;  // those that there should be
};

// A cloud of more points than this (1 GB) is a damaged file, not a sweep.
constexpr bool fits_in_memory(std::size_t lines, std::size_t beams) {
  return lines * beams <= (std::size_t{1} << 26);
}

// Fills in ranges and intensities of the next line, in order, each line once.
using LineReader = std::function<Outcome(msg::ScanLine&)>;

struct RecordingPlan {
  RecordingFacts facts;
  msg::ScanLine line;  // what all lines share: angles, periods, limits
  std::vector<RecordedLine> lines;
  std::vector<RecordedSweep> sweeps;  // in order, not overlapping
  LineReader read_line;

  // From a line's first beam to its last.
  std::int64_t line_duration_ns() const;
};

}  // namespace swivel
