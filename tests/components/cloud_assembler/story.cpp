#include "tests/components/cloud_assembler/story.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/calibration/unlike_rig.hpp"

namespace swivel {
namespace {

constexpr double kFirstBeamDeg = -135.0;
constexpr double kBeamStepDeg = 14.9;

// Unlike for every beam of every line.
std::uint16_t range_mm(int line, std::size_t beam) {
  return static_cast<std::uint16_t>(1000 + (37 * (line + 40) + 11 * static_cast<int>(beam)) % 8999);
}

double beam_period_ns(const Story& story) {
  return static_cast<double>(story.scan_period_ns) / 24.3;
}

msg::AxisSample sample(const Story& story, std::int64_t time_ns) {
  msg::AxisSample sample;
  sample.time_ns(time_ns);
  sample.angle_deg(deg_from_rad(story.axis_angle_rad(time_ns)));
  return sample;
}

}  // namespace

double Story::axis_angle_rad(std::int64_t time_ns) const {
  const double elapsed_s = s_from_ns(static_cast<double>(time_ns - window_start_ns()));
  return rad_from_deg(first_angle_deg + speed_deg_s * elapsed_s);
}

msg::ScanLine Story::line(int index) const {
  msg::ScanLine line;
  line.beam0_time_ns(line_time_ns(index));
  line.device_stamp_ms(static_cast<std::uint32_t>(5000 + 25 * index));
  line.first_beam_angle_deg(kFirstBeamDeg);
  line.beam_step_deg(kBeamStepDeg);
  line.beam_period_ns(beam_period_ns(*this));
  line.scan_period_ns(static_cast<double>(scan_period_ns));
  line.range_min_mm(60);
  line.range_max_mm(10000);
  for (std::size_t beam = 0; beam < beams; ++beam) {
    line.ranges_mm().push_back(range_mm(index, beam));
    line.intensities().push_back(static_cast<std::uint16_t>(200 + beam));
  }
  return line;
}

msg::Axis Story::axis() const {
  msg::Axis axis;
  axis.source(msg::AXIS_COMMANDED);
  axis.samples({sample(*this, window_start_ns()), sample(*this, window_end_ns())});
  return axis;
}

msg::Sweep Story::phase(msg::SweepPhase phase, const std::string& reason) const {
  msg::Sweep sweep;
  sweep.sweep_id(sweep_id);
  sweep.phase(phase);
  sweep.mode(3);
  sweep.speed_deg_s(speed_deg_s);
  sweep.lines_expected(lines);
  sweep.window_start_ns(window_start_ns());
  sweep.window_end_ns(window_end_ns());
  sweep.window_lines(lines);
  sweep.time_ns(phase == msg::PHASE_CRUISING ? window_start_ns() : window_end_ns());
  sweep.reason(reason);
  return sweep;
}

RigGeometry story_geometry() {
  return unlike_rig();
}

AssemblyOptions story_options() {
  AssemblyOptions options;
  options.geometry = story_geometry();
  return options;
}

Stage::Stage(const AssemblyOptions& options)
    : assembler(options, [this](AssembledSweep&& sweep) { sweeps.push_back(std::move(sweep)); }) {
  assembler.check(now_);
}

void Stage::add(const Event& event) {
  std::visit([this](const auto& message) { assembler.add(message); }, event);
}

void Stage::add_lines(const Story& story, int first, int end, std::optional<int> lost) {
  for (int index = first; index < end; ++index) {
    if (index != lost) assembler.add(story.line(index));
  }
}

void Stage::check_after_s(double seconds) {
  assembler.check(now_);
  now_ += std::chrono::milliseconds(std::llround(1000.0 * seconds));
  assembler.check(now_);
}

void Stage::expect_counters_add_up() const {
  const AssemblerCounters& counters = assembler.counters();
  EXPECT_EQ(counters.lines_received, counters.lines_used + counters.lines_outside +
                                         counters.lines_rejected + counters.lines_late +
                                         assembler.lines_waiting());
}

OrganisedCloud expected_cloud(const Story& story, const std::vector<int>& lost) {
  const ForwardModel model(story_geometry(), rad_from_deg(kFirstBeamDeg),
                           rad_from_deg(kBeamStepDeg), story.beams);
  OrganisedCloud cloud(story.lines, story.beams);
  const double zero_rad = story.axis_angle_rad(story.line_time_ns(0));
  for (int row = 0; row < static_cast<int>(story.lines); ++row) {
    if (std::find(lost.begin(), lost.end(), row) != lost.end()) continue;
    for (std::size_t beam = 0; beam < story.beams; ++beam) {
      const double delay_ns = static_cast<double>(beam) * beam_period_ns(story);
      const std::int64_t time_ns = story.line_time_ns(row) + std::llround(delay_ns);
      const Eigen::Vector3d point = model.point(beam, m_from_mm(range_mm(row, beam)),
                                                story.axis_angle_rad(time_ns) - zero_rad);
      cloud.line(static_cast<std::size_t>(row))[beam] = {
          static_cast<float>(point.x()), static_cast<float>(point.y()),
          static_cast<float>(point.z()), 200.0F + static_cast<float>(beam)};
    }
  }
  return cloud;
}

void expect_same(const OrganisedCloud& cloud, const OrganisedCloud& expected) {
  ASSERT_EQ(cloud.lines, expected.lines);
  ASSERT_EQ(cloud.beams, expected.beams);
  for (std::size_t index = 0; index < expected.points.size(); ++index) {
    const CloudPoint& point = cloud.points[index];
    const CloudPoint& truth = expected.points[index];
    ASSERT_EQ(point.valid(), truth.valid()) << "point " << index;
    ASSERT_EQ(std::isnan(point.intensity), std::isnan(truth.intensity)) << "point " << index;
    if (!truth.valid()) continue;
    ASSERT_NEAR(point.x_m, truth.x_m, 2e-6) << "point " << index;
    ASSERT_NEAR(point.y_m, truth.y_m, 2e-6) << "point " << index;
    ASSERT_NEAR(point.z_m, truth.z_m, 2e-6) << "point " << index;
    ASSERT_EQ(point.intensity, truth.intensity) << "point " << index;
  }
}

}  // namespace swivel
