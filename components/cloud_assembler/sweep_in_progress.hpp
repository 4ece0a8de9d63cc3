// One sweep while its lines come in.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/axis_track.hpp"
#include "calibration/line_assembly.hpp"
#include "calibration/organised_cloud.hpp"
#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

// The instant of a line's last beam.
std::int64_t last_beam_time_ns(const msg::ScanLine& line);

struct AssemblyOptions {
  RigGeometry geometry;
  bool axis_measured = false;
  Timing timing = Timing::kPerBeam;
  double sweep_angle_rad = kPi;  // for Timing::kEq7
};

class SweepInProgress {
 public:
  enum class Fate { kPlaced, kBeforeWindow, kBeyondWindow, kOtherShape };

  // sweep: the message that announced the sweep's first window.
  SweepInProgress(const AssemblyOptions& options, const msg::Sweep& sweep);

  void add_window(const msg::Sweep& sweep);

  // line must not be before one that was placed; axis must cover it.
  Fate place(const msg::ScanLine& line, const AxisTrack& axis);

  bool last_line_is_in() const { return next_row_ >= lines_expected_; }
  // Every line of the windows announced so far is in, or its time is over.
  bool waits_for_window() const { return windows_.empty(); }
  std::uint64_t id() const { return announced_.sweep_id(); }
  std::size_t lines_used() const { return lines_used_; }
  // From the first window's start to the last one's end.
  bool spans(const msg::ScanLine& line) const;

  // What is known of the sweep now, as PHASE_ASSEMBLED.
  msg::Sweep summary(const std::string& reason) const;
  OrganisedCloud take_cloud() { return std::move(cloud_); }

 private:
  struct Window {
    std::int64_t start_ns;
    std::int64_t end_ns;
    std::size_t first_row;
    std::size_t rows;
  };

  bool fits(const msg::ScanLine& line) const;
  std::size_t row_of(const msg::ScanLine& line) const;
  void begin(const msg::ScanLine& line, const AxisTrack& axis);
  void write_row(std::size_t row, const msg::ScanLine& line, const AxisTrack& axis);

  AssemblyOptions options_;
  msg::Sweep announced_;
  std::size_t lines_expected_;
  std::vector<Window> windows_;  // still open, in order of time
  std::int64_t last_end_ns_;
  std::optional<LineAssembler> assembler_;  // once the first line told the lidar's shape
  msg::ScanLine first_line_;
  double first_angle_rad_ = 0.0;  // the axis angle that is 0 in frame O'
  std::int64_t previous_time_ns_ = 0;
  bool previous_in_window_ = false;
  std::size_t next_row_ = 0;
  std::size_t lines_used_ = 0;
  OrganisedCloud cloud_;
};

}  // namespace swivel
