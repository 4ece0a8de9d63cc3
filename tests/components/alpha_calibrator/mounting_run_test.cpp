// A calibration run for the mounting: lines, angles and windows of a simulated pan unit, in the
// order in which they come.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "components/alpha_calibrator/calibrator.hpp"
#include "components/common/calibration_file.hpp"
#include "tests/calibration/pan_scan.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriod_ns = 25'000'000;
constexpr double kBeamPeriod_ns = 25e6 / 1440.0;

RigFile pan_rig() {
  RigFile rig;
  rig.rig = "zeng";
  rig.axis_measured = true;
  return rig;
}

msg::ScanLine line_of(const LineOfReadings& readings, std::int64_t beam0_time_ns) {
  msg::ScanLine line;
  line.beam0_time_ns(beam0_time_ns);
  line.first_beam_angle_deg(-135.0);
  line.beam_step_deg(0.25);
  line.beam_period_ns(kBeamPeriod_ns);
  line.scan_period_ns(static_cast<double>(kPeriod_ns));
  line.range_min_mm(23);
  line.range_max_mm(60000);
  for (const float range_m : readings.ranges_m) {
    const bool valid = std::isfinite(range_m);
    line.ranges_mm().push_back(
        static_cast<std::uint16_t>(valid ? std::lround(range_m * 1000.0F) : 1));
  }
  return line;
}

msg::AxisSample sample_of(std::int64_t time_ns, double angle_rad) {
  msg::AxisSample sample;
  sample.time_ns(time_ns);
  sample.angle_deg(deg_from_rad(angle_rad));
  return sample;
}

class MountingRun : public testing::Test {
 protected:
  void ask(std::uint16_t count) {
    msg::CalibrationRequest request;
    request.request_id(7);
    request.kind(msg::CALIBRATION_OF_MOUNTING);
    request.mode(1);
    request.count(count);
    calibrator_.take(request);
  }

  msg::Sweep phase(std::uint64_t id, msg::SweepPhase phase, std::size_t lines) const {
    msg::Sweep sweep;
    sweep.request_id(requests_.back().request_id());
    sweep.sweep_id(id);
    sweep.phase(phase);
    sweep.mode(1);
    sweep.lines_expected(static_cast<std::uint32_t>(lines));
    sweep.window_lines(static_cast<std::uint32_t>(lines));
    sweep.window_start_ns(start_ns(id) - 1'000'000);
    sweep.window_end_ns(start_ns(id) + static_cast<std::int64_t>(lines) * kPeriod_ns);
    sweep.time_ns(sweep.window_start_ns());
    return sweep;
  }

  // Without every line from `lost` on.
  void sweep_the_room(std::uint64_t id, const PanScan& scan, std::size_t lost = 1'000'000) {
    const SweepReadings readings = scan_of(scan);
    calibrator_.take(phase(id, msg::PHASE_CRUISING, readings.lines.size()));
    for (std::size_t index = 0; index < std::min(lost, readings.lines.size()); ++index) {
      const LineOfReadings& line = readings.lines[index];
      const std::int64_t beam0_ns = start_ns(id) + static_cast<std::int64_t>(index) * kPeriod_ns;
      const double last = static_cast<double>(line.ranges_m.size() - 1);
      msg::Axis axis;
      axis.source(msg::AXIS_MEASURED);
      axis.samples({sample_of(beam0_ns, line.axis_angle_rad),
                    sample_of(beam0_ns + std::llround(last * kBeamPeriod_ns),
                              line.axis_angle_rad + last * line.angle_per_beam_rad)});
      calibrator_.take(line_of(line, beam0_ns));
      calibrator_.take(axis);
    }
    calibrator_.take(phase(id, msg::PHASE_DECELERATING, readings.lines.size()));
  }

  // As the participant's tick does, until the fits beside it are done.
  void await_end() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (calibrator_.running() && std::chrono::steady_clock::now() < deadline) {
      now_ += std::chrono::milliseconds(100);
      calibrator_.check(now_);
      std::this_thread::yield();
    }
    ASSERT_FALSE(calibrator_.running());
  }

  std::vector<msg::SweepRequest> requests_;
  std::vector<msg::CalibrationProgress> told_;
  std::vector<msg::Calibration> published_;
  Calibrator calibrator_{pan_rig(),
                         {[this](const auto& request) { requests_.push_back(request); },
                          [this](const auto& progress) { told_.push_back(progress); },
                          [this](const auto& calibration) { published_.push_back(calibration); }}};
  std::chrono::steady_clock::time_point now_{std::chrono::hours(1)};

 private:
  static std::int64_t start_ns(std::uint64_t id) {
    return kStart_ns + static_cast<std::int64_t>(id) * 100'000'000'000;
  }
};

TEST_F(MountingRun, FindsTheMountingOfASweepAndLeavesOutOneThatIsNotWhole) {
  calibrator_.name_lidar({"H30", "1.18"});
  ask(2);
  ASSERT_EQ(requests_.size(), 1U);
  PanScan scan;
  scan.lines = 90;
  scan.bias_deg = 3.0;
  scan.ry_deg = 0.5;
  scan.ty_mm = -4.0;
  sweep_the_room(1, scan, 50);
  sweep_the_room(2, scan);
  await_end();
  ASSERT_EQ(published_.size(), 1U) << told_.back().words();
  EXPECT_EQ(told_.back().sweeps_used(), 1);
  EXPECT_EQ(told_.back().sweeps_left_out(), 1);
  const msg::Calibration& found = published_[0];
  EXPECT_NEAR(found.bias_deg(), 3.0, 0.01);
  EXPECT_NEAR(found.mounting_rpy_deg()[1], 0.5, 0.05);
  EXPECT_NEAR(found.mounting_xyz_mm()[1], -4.0, 0.6);
  const auto sigma = [&](CalibrationIndex index) {
    return std::sqrt(found.covariance()[index * kCalibrationSize + index]);
  };
  EXPECT_LT(std::abs(found.bias_deg() - 3.0), 4.0 * sigma(kBias));
  EXPECT_LT(std::abs(found.mounting_rpy_deg()[1] - 0.5), 4.0 * sigma(kPitch));
  EXPECT_LT(std::abs(found.mounting_xyz_mm()[1] + 4.0), 4.0 * sigma(kMountingY));
  EXPECT_EQ(found.rig().to_string(), "zeng");
  EXPECT_EQ(found.serial_number(), "H30");
  EXPECT_TRUE(tells_mounting(found));
  EXPECT_FALSE(tells_alpha(found));
}

TEST_F(MountingRun, WithoutAWholeSweepItIsRefused) {
  ask(1);
  PanScan scan;
  scan.lines = 20;
  sweep_the_room(1, scan, 12);
  await_end();
  EXPECT_TRUE(published_.empty());
  EXPECT_EQ(told_.back().state(), msg::CALIBRATION_REFUSED);
  EXPECT_THAT(told_.back().words(), HasSubstr("no sweep"));
}

// As where the participant is stopped: a fit under way takes seconds, and its end is waited for.
TEST(MountingRunStopped, AFitThatNobodyWantsAnyMoreEndsAtTheNextStep) {
  PanScan scan;
  scan.lines = 180;
  const SweepReadings readings = scan_of(scan);
  int asked = 0;
  const MountingResult result = fit_mounting(readings, RigGeometry(), [&asked] {
    ++asked;
    return true;
  });
  EXPECT_FALSE(result.fit);
  EXPECT_EQ(result.reason, "cancelled");
  EXPECT_LE(asked, 4) << "no step was taken";
}

TEST_F(MountingRun, AlphaOfARigWithoutAPlateIsRefused) {
  msg::CalibrationRequest request;
  request.request_id(8);
  request.count(3);
  calibrator_.take(request);
  EXPECT_EQ(told_.back().state(), msg::CALIBRATION_REFUSED);
  EXPECT_THAT(told_.back().words(), HasSubstr("no plate"));
  request.kind(static_cast<msg::CalibrationKind>(9));
  calibrator_.take(request);
  EXPECT_THAT(told_.back().words(), HasSubstr("no such calibration"));
  EXPECT_TRUE(requests_.empty());
}

}  // namespace
}  // namespace swivel
