// A recording of a rig, played as the messages that its reader and sequencer would have sent,
// so that assembler, corrector and calibrator run unchanged.
//
// Three kinds are read. Formats in full: the README beside each of the last two.
//   FILE.mcap     a live rig, by swivel record: the very messages, and the calibration
//   FILE.csv.gz   real scanners: # metadata, then `stamp_ns;axis_angle_deg;ranges;intensities`
//                 a line; the axis angle may be missing
//   FOLDER        a case: meta.csv, lines.csv, ranges.u16, intensity.u16
//
// Where the axis was measured, each line brings its angle. Where it was not (the plate rig),
// the angle is the one commanded: constant speed from 0 at the sweep's first beam.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hardware/result.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct RecordedEvent {
  std::int64_t time_ns = 0;  // when it would have been sent; never before the event before it
  std::variant<msg::ScanLine, msg::Axis, msg::Sweep, msg::Calibration> message;
};

struct RecordingFacts {
  std::string rig;            // that made it, by its topics; empty: not told
  std::string suggested_rig;  // file name in config/rigs without .yaml; empty: none suits
  std::string remark;         // what the user should know, in words; empty: nothing
  bool axis_measured = false;
  std::size_t lines = 0;
  std::size_t beams = 0;
  double scan_period_ns = 0.0;  // as the stamps say, not nominal
  std::vector<int> modes;       // one a sweep; 0: none of the seven

  // Of the plate rig, as its case says.
  struct Plate {
    double lever_arm_m = 0.0;
    double base_distance_m = 0.0;
    double hypotenuse_m = 0.0;
    double depth_m = 0.0;
    double alpha_deg = 0.0;  // nominal
    double room_yaw_deg = 0.0;
  };
  std::optional<Plate> plate;
};

class Recording {
 public:
  // Reads times and angles, and checks that all is whole. `rig` becomes the messages' key.
  // That of a live rig has its own.
  static Result<Recording> open(const std::string& path, const std::string& rig = "swivel");

  // The next event; nothing at the end.
  using Next = std::function<Result<std::optional<RecordedEvent>>()>;
  Recording(RecordingFacts facts, Next next) : facts_(std::move(facts)), next_(std::move(next)) {}

  const RecordingFacts& facts() const { return facts_; }
  Result<std::optional<RecordedEvent>> next() { return next_(); }

 private:
  RecordingFacts facts_;
  Next next_;
};

}  // namespace swivel
