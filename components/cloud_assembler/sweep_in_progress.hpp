// One sweep while its lines come in.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/axis_track.hpp"
#include "calibration/line_assembly.hpp"
#include "calibration/organised_cloud.hpp"
#include "calibration/sweep_readings.hpp"
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
  bool keep_readings = false;    // for a calibration: what the cloud was made of, too
};

class SweepInProgress {
 public:
  // kRefused: of another shape than the sweep's first line, told twice, or too large a cloud.
  enum class Fate { kPlaced, kBeforeWindow, kBeyondWindow, kRefused };

  // sweep: the message that announced the sweep's first window.
  SweepInProgress(const AssemblyOptions& options, const msg::Sweep& sweep);

  // False if it does not continue the windows before it.
  bool add_window(const msg::Sweep& sweep);

  // Gives up the windows that line, and so every later one, is too late for.
  void leave_windows_before(const msg::ScanLine& line);
  // Whether line lies wholly inside the window that is open.
  bool takes(const msg::ScanLine& line) const;
  // A window must be open; axis must cover the line if it takes it.
  Fate place(const msg::ScanLine& line, const AxisTrack& axis);

  // Every line of the windows announced so far is in, or its time is over.
  bool waits_for_window() const { return windows_.empty(); }
  bool is_over() const { return windows_.empty() && rows_announced_ >= lines_expected_; }
  const msg::Sweep& announced() const { return announced_; }

  // What is known of the sweep now, as PHASE_ASSEMBLED.
  msg::Sweep summary(const std::string& reason) const;
  const OrganisedCloud& cloud() const { return cloud_; }  // empty before the first line
  std::size_t last_row() const { return previous_row_; }  // of the line placed last
  OrganisedCloud take_cloud() { return std::move(cloud_); }
  SweepReadings take_readings() { return std::move(readings_); }

 private:
  struct Window {
    std::int64_t start_ns;
    std::int64_t end_ns;
    std::size_t first_row;
    std::size_t rows;
  };

  void leave_window();
  bool fits(const msg::ScanLine& line) const;
  std::optional<std::size_t> row_of(const msg::ScanLine& line) const;
  bool begin(const msg::ScanLine& line, const AxisTrack& axis);
  void write_row(std::size_t row, const msg::ScanLine& line, const AxisTrack& axis);
  void keep_line(const msg::ScanLine& line, const AxisTrack& axis);
  bool turns_down() const;

  AssemblyOptions options_;
  msg::Sweep announced_;
  std::size_t lines_expected_;
  std::vector<Window> windows_;  // still open, in order of time
  std::int64_t last_end_ns_;     // of the windows announced so far, and the rows in them
  std::size_t rows_announced_ = 0;
  std::optional<LineAssembler> assembler_;  // once the first line told the lidar's shape
  msg::ScanLine first_line_;
  double first_angle_rad_ = 0.0;     // the axis angle that is 0 in frame O'
  bool previous_in_window_ = false;  // the line before was in the window that is open
  std::int64_t previous_time_ns_ = 0;
  std::size_t previous_row_ = 0;
  std::size_t lines_used_ = 0;
  OrganisedCloud cloud_;
  SweepReadings readings_;
};

}  // namespace swivel
