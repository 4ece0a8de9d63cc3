// From scan lines, axis angles and windows to organised clouds, as the lines arrive.
//
// A sweep is begun by a Sweep message with a window (PHASE_CRUISING). The lines that lie wholly
// inside the window become its rows, each beam at its own instant and at the axis angle of that
// instant. Lines, angles and windows travel on topics of their own and may overtake each
// other, so recent lines are kept until their window and their angles are known.
//
// What ends a sweep early, a cancel or a fault, makes it incomplete and takes its cloud away; if
// it had already gone out as complete, a second Sweep says so.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "calibration/axis_track.hpp"
#include "components/cloud_assembler/sweep_in_progress.hpp"
#include "components/common/rig_file.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

struct AssembledSweep {
  msg::Sweep sweep;        // PHASE_ASSEMBLED; tells whether the sweep is complete
  OrganisedCloud cloud;    // frame O' if the axis is commanded, base if it is measured;
                           // empty if there is nothing to be trusted
  SweepReadings readings;  // of the lines used, where they are kept; angles from where the cloud's
                           // are, without hysteresis
};

// lines_received = used + outside + rejected + late + Assembler::lines_waiting().
struct AssemblerCounters {
  std::uint64_t lines_received = 0;
  std::uint64_t lines_used = 0;
  std::uint64_t lines_outside = 0;   // of every window: the lidar streams at all times
  std::uint64_t lines_rejected = 0;  // malformed, twice, or of another shape than the sweep's
  std::uint64_t lines_late = 0;      // inside the window of a sweep that was closed without them
  std::uint64_t lines_missing = 0;
  std::uint64_t axis_samples_rejected = 0;  // not later, or not of the rig's kind of axis
  std::uint64_t windows_rejected = 0;       // malformed, or not after the one before
  std::uint64_t sweeps_complete = 0;
  std::uint64_t sweeps_incomplete = 0;
  std::uint64_t sweeps_before_start = 0;  // told of at the start, their lines long gone
};

class Assembler {
 public:
  Assembler(const AssemblyOptions& options, std::function<void(AssembledSweep&&)> on_sweep);

  // Told of each row as it is placed, for who wants to see a sweep while it runs.
  using OnRow = std::function<void(const msg::Sweep& announced, const OrganisedCloud& cloud,
                                   std::size_t row)>;
  void on_row(OnRow on_row) { on_row_ = std::move(on_row); }

  void add(const msg::ScanLine& line);
  void add(const msg::Axis& axis);
  void add(const msg::Sweep& sweep);

  // To be called now and then with a steady clock: closes a sweep whose lines do not come. A
  // window must open within 5 s of its announcement. The first call is the start: what was said
  // before it comes within the next 2 s.
  void check(std::chrono::steady_clock::time_point now);

  // Closes what is open: no more will come.
  void finish();

  // From the next sweep on.
  void set_geometry(const RigGeometry& geometry) { options_.geometry = geometry; }

  const AssemblerCounters& counters() const { return counters_; }
  std::size_t lines_waiting() const { return waiting_.size(); }

 private:
  void add(const msg::AxisSample& sample);
  void begin_or_extend(const msg::Sweep& sweep);
  void begin(const msg::Sweep& sweep);
  bool told_before(const msg::Sweep& sweep) const;
  void end(const msg::Sweep& sweep);
  void abandon(const msg::Sweep& ended, const std::string& why);
  void place_lines();
  void place(const msg::ScanLine& line);
  bool lacks_angles() const;
  void close(const std::string& reason);
  bool was_before_our_time() const;
  bool belongs_to_last_closed(const msg::ScanLine& line) const;
  void forget_old_lines();

  AssemblyOptions options_;
  std::function<void(AssembledSweep&&)> on_sweep_;
  OnRow on_row_;
  AxisTrack axis_;
  std::int64_t last_axis_ns_ = 0;
  std::uint64_t last_axis_number_ = 0;
  std::deque<msg::ScanLine> waiting_;  // in order of time
  std::unique_ptr<SweepInProgress> sweep_;
  msg::Sweep last_closed_;
  std::int64_t last_used_ns_ = 0;   // of the last line placed, its last beam
  bool ending_ = false;             // the sequencer has left the window, and all was well
  bool news_ = false;               // since the last check
  bool told_at_start_ = false;      // of the sweep
  std::int64_t first_line_ns_ = 0;  // of all that ever came
  std::optional<std::chrono::steady_clock::time_point> start_;
  std::chrono::steady_clock::time_point last_check_{};
  std::chrono::steady_clock::time_point last_news_{};
  std::chrono::steady_clock::time_point ending_since_{};
  AssemblerCounters counters_;
};

}  // namespace swivel
