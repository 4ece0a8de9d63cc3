// One sweep told as its messages, and what the forward model makes of them.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "components/cloud_assembler/assembler.hpp"

namespace swivel {

constexpr std::int64_t kMillisecondNs = 1'000'000;

struct Story {
  std::uint64_t sweep_id = 7;
  std::uint32_t lines = 12;
  std::size_t beams = 19;
  std::int64_t first_beam_ns = 1'700'000'000'123'456'789;  // of line 0
  std::int64_t scan_period_ns = 25'040'000;
  std::int64_t true_period_ns = 25'040'000;  // the lines say scan_period_ns
  double first_angle_deg = 33.0;             // of the axis at the window's start
  double speed_deg_s = 45.0;

  std::int64_t line_time_ns(int index) const { return first_beam_ns + index * true_period_ns; }
  std::int64_t window_start_ns() const { return first_beam_ns - 2 * kMillisecondNs; }
  std::int64_t window_end_ns() const { return line_time_ns(static_cast<int>(lines)); }
  double axis_angle_rad(std::int64_t time_ns) const;

  msg::ScanLine line(int index) const;  // may be before the sweep or after it
  msg::Axis axis() const;               // the window's
  msg::Sweep phase(msg::SweepPhase phase, const std::string& reason = "") const;
  msg::Sweep cruising() const { return phase(msg::PHASE_CRUISING); }
};

RigGeometry story_geometry();  // no two numbers alike
AssemblyOptions story_options();

using Event = std::variant<msg::Sweep, msg::Axis, msg::ScanLine>;
using TopicEvents = std::vector<Event>;

// An assembler and all that came out of it.
class Stage {
 public:
  explicit Stage(const AssemblyOptions& options = story_options());

  void add(const Event& event);
  void add_lines(const Story& story, int first, int end, std::optional<int> lost = {});
  void check_after_s(double seconds);
  void expect_counters_add_up() const;

  Assembler assembler;
  std::vector<AssembledSweep> sweeps;

 private:
  std::chrono::steady_clock::time_point now_{std::chrono::hours(1)};
};

// The cloud that the story's lines make; of lines that are not lost.
OrganisedCloud expected_cloud(const Story& story, const std::vector<int>& lost = {});

// Rows and columns alike, NaN at the same places, points within 2 micrometres and float rounding.
void expect_same(const OrganisedCloud& cloud, const OrganisedCloud& expected);

}  // namespace swivel
