#include "components/cloud_assembler/assembler.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/transform_cloud.hpp"
#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

TEST(Assembler, PutsEveryBeamAtTheAxisAngleOfItsOwnInstant) {
  const Story story;
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, -3, 12);
  ASSERT_EQ(stage.sweeps.size(), 1U);  // out when the last line is in
  const msg::Sweep& sweep = stage.sweeps[0].sweep;
  EXPECT_TRUE(sweep.complete()) << sweep.reason();
  EXPECT_EQ(sweep.phase(), msg::PHASE_ASSEMBLED);
  EXPECT_EQ(sweep.first_beam_time_ns(), story.first_beam_ns);
  EXPECT_EQ(sweep.first_device_stamp_ms(), 5000U);
  EXPECT_EQ(sweep.lines_used(), 12U);
  EXPECT_EQ(sweep.lines_missing(), 0U);
  EXPECT_TRUE(sweep.reason().empty());
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
  EXPECT_EQ(stage.assembler.counters().lines_outside, 3U);
  stage.expect_counters_add_up();
}

TEST(Assembler, TellsOfEachRowAsItIsPlaced) {
  const Story story;
  Stage stage;
  std::vector<std::size_t> rows;
  OrganisedCloud seen(story.lines, story.beams);
  stage.assembler.on_row(
      [&](const msg::Sweep& announced, const OrganisedCloud& cloud, std::size_t row) {
        EXPECT_EQ(announced.sweep_id(), story.sweep_id);
        rows.push_back(row);
        std::copy_n(cloud.line(row), cloud.beams, seen.line(row));
      });
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, -3, 7, 4);
  EXPECT_EQ(rows, (std::vector<std::size_t>{0, 1, 2, 3, 5, 6})) << "before the sweep is over";
  stage.add_lines(story, 7, 14);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  expect_same(seen, stage.sweeps[0].cloud);
}

TEST(Assembler, LinesOutsideTheWindowAreNotUsed) {
  Story story;
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, -8, 20);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  expect_same(stage.sweeps[0].cloud, expected_cloud(story));
  EXPECT_EQ(stage.assembler.counters().lines_used, 12U);
  EXPECT_EQ(stage.assembler.counters().lines_outside, 8U);
  EXPECT_EQ(stage.assembler.lines_waiting(), 8U);
}

TEST(Assembler, ALineHalfInsideTheWindowIsNotUsed) {
  Story story;
  msg::Sweep sweep = story.cruising();
  sweep.window_start_ns(story.first_beam_ns + 1);
  Stage stage;
  stage.add(story.axis());
  stage.add(sweep);
  stage.add_lines(story, 0, 13);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  // Line 12 begins at the window's end, so only eleven are wholly inside.
  EXPECT_FALSE(stage.sweeps[0].sweep.complete());
  EXPECT_EQ(stage.sweeps[0].sweep.lines_used(), 11U);
  EXPECT_EQ(stage.sweeps[0].sweep.first_beam_time_ns(), story.line_time_ns(1));
}

// A measured axis is taken as it is: not from the first beam on.
TEST(Assembler, AMeasuredAxisGivesTheBaseItself) {
  const Story story;
  AssemblyOptions options = story_options();
  options.axis_measured = true;
  msg::Axis axis = story.axis();
  axis.source(msg::AXIS_MEASURED);
  Stage stage(options);
  stage.add(axis);
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  ASSERT_EQ(stage.sweeps.size(), 1U);

  Stage commanded;
  commanded.add(story.axis());
  commanded.add(story.cruising());
  commanded.add_lines(story, 0, 12);
  const double zero_rad = story.axis_angle_rad(story.first_beam_ns);
  const Eigen::Isometry3d& T_base_axis = story_geometry().T_base_axis;
  const Eigen::Isometry3d T_base_start =
      T_base_axis * Eigen::AngleAxisd(zero_rad, Eigen::Vector3d::UnitZ()) * T_base_axis.inverse();
  const CloudPoint& turned = commanded.sweeps[0].cloud.line(5)[7];
  const Eigen::Vector3d expected =
      T_base_start * Eigen::Vector3f(turned.x_m, turned.y_m, turned.z_m).cast<double>();
  const CloudPoint& point = stage.sweeps[0].cloud.line(5)[7];
  EXPECT_LT((Eigen::Vector3f(point.x_m, point.y_m, point.z_m).cast<double>() - expected).norm(),
            3e-6);
}

// What is kept for a calibration, put through the forward model, is the cloud.
TEST(Assembler, KeepsWhatTheCloudWasMadeOf) {
  const Story story;
  AssemblyOptions options = story_options();
  options.keep_readings = true;
  Stage stage(options);
  stage.add(story.axis());
  stage.add(story.cruising());
  stage.add_lines(story, 0, 12);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  const SweepReadings& readings = stage.sweeps[0].readings;
  ASSERT_EQ(readings.lines.size(), 12U);
  const ForwardModel model(story_geometry(), readings.first_beam_angle_rad, readings.beam_step_rad,
                           readings.beams());
  OrganisedCloud cloud = stage.sweeps[0].cloud;
  for (std::size_t row = 0; row < cloud.lines; ++row) {
    const LineOfReadings& line = readings.lines[row];
    EXPECT_FALSE(line.turning_down);
    for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
      const Eigen::Vector3f p =
          model
              .point(beam, line.ranges_m[beam],
                     line.axis_angle_rad + static_cast<double>(beam) * line.angle_per_beam_rad)
              .cast<float>();
      cloud.line(row)[beam] = {p.x(), p.y(), p.z(), cloud.line(row)[beam].intensity};
    }
  }
  expect_same(stage.sweeps[0].cloud, cloud);
}

TEST(Assembler, ASweepDownIsTurnedByTheHysteresisAndOneUpIsNot) {
  for (const bool down : {false, true}) {
    Story story;
    story.speed_deg_s = down ? -45.0 : 45.0;
    AssemblyOptions options = story_options();
    options.axis_measured = true;
    options.keep_readings = true;
    options.geometry.hysteresis_rad = 0.01;
    msg::Axis axis = story.axis();
    axis.source(msg::AXIS_MEASURED);
    const auto sweep_by = [&](const AssemblyOptions& how) {
      Stage stage(how);
      stage.add(axis);
      stage.add(story.cruising());
      stage.add_lines(story, 0, 12);
      return std::move(stage.sweeps.at(0));
    };
    const AssembledSweep with = sweep_by(options);
    options.geometry.hysteresis_rad = 0.0;
    AssembledSweep expected = sweep_by(options);
    const Eigen::Isometry3d& T_base_axis = story_geometry().T_base_axis;
    const Eigen::AngleAxisd turn(down ? 0.01 : 0.0, Eigen::Vector3d::UnitZ());
    transform_cloud(T_base_axis * turn * T_base_axis.inverse(), expected.cloud);
    expect_same(with.cloud, expected.cloud);
    EXPECT_EQ(with.readings.lines[3].axis_angle_rad, expected.readings.lines[3].axis_angle_rad);
    EXPECT_EQ(with.readings.lines[3].turning_down, down);
  }
}

TEST(Assembler, AnAxisThatIsNotStraightInsideALineIsFollowedBeamByBeam) {
  const Story story;
  AssemblyOptions options = story_options();
  options.axis_measured = true;
  msg::Axis axis;
  axis.source(msg::AXIS_MEASURED);
  for (std::int64_t t = story.window_start_ns(); t <= story.window_end_ns(); t += 3'000'000) {
    msg::AxisSample sample;
    sample.time_ns(t);
    sample.angle_deg(std::pow(static_cast<double>(t - story.window_start_ns()) * 1e-8, 2.0));
    axis.samples().push_back(sample);
  }
  Stage stage(options);
  stage.add(axis);
  stage.add(story.cruising());
  stage.add_lines(story, 0, 11);
  stage.assembler.finish();
  ASSERT_EQ(stage.sweeps.size(), 1U);

  const msg::ScanLine line = story.line(6);
  const ForwardModel model(story_geometry(), rad_from_deg(line.first_beam_angle_deg()),
                           rad_from_deg(line.beam_step_deg()), story.beams);
  for (const std::size_t beam : {0U, 7U, 18U}) {
    const double time_ns = static_cast<double>(line.beam0_time_ns() - story.window_start_ns()) +
                           static_cast<double>(beam) * line.beam_period_ns();
    const double angle_rad = rad_from_deg(std::pow(time_ns * 1e-8, 2.0));
    const Eigen::Vector3d truth = model.point(beam, m_from_mm(line.ranges_mm()[beam]), angle_rad);
    const CloudPoint& point = stage.sweeps[0].cloud.line(6)[beam];
    const Eigen::Vector3d found = Eigen::Vector3f(point.x_m, point.y_m, point.z_m).cast<double>();
    // A chord of 3 ms lies 0.0225 deg from the parabola; the sweep's speed moves a beam by 40 times
    // that.
    EXPECT_LT((found - truth).norm(), 2.5 * rad_from_deg(0.03)) << beam;
  }
}

// Yuan 2021, eq. 7: point k of the sweep's K stands at k / K * 180 deg.
TEST(Assembler, Eq7SpreadsThePointsEvenlyWhateverTheAxisDid) {
  const Story story;
  AssemblyOptions options = story_options();
  options.timing = Timing::kEq7;
  Stage stage(options);
  stage.add(story.cruising());  // no axis at all
  stage.add_lines(story, 0, 12);
  ASSERT_EQ(stage.sweeps.size(), 1U);
  ASSERT_TRUE(stage.sweeps[0].sweep.complete());
  const std::size_t K = story.lines * story.beams;
  for (std::size_t k = 0; k < K; ++k) {
    const msg::ScanLine line = story.line(static_cast<int>(k / story.beams));
    const ForwardModel model(story_geometry(), rad_from_deg(line.first_beam_angle_deg()),
                             rad_from_deg(line.beam_step_deg()), story.beams);
    const std::size_t beam = k % story.beams;
    const double angle_rad = static_cast<double>(k) / static_cast<double>(K) * kPi;
    const Eigen::Vector3d truth = model.point(beam, m_from_mm(line.ranges_mm()[beam]), angle_rad);
    const CloudPoint& point = stage.sweeps[0].cloud.points[k];
    ASSERT_LT((Eigen::Vector3f(point.x_m, point.y_m, point.z_m).cast<double>() - truth).norm(),
              3e-6);
  }
}

TEST(Assembler, ATruePeriodOff25msDoesNotDriftTheRows) {
  Story story;
  story.lines = 640;
  story.speed_deg_s = 11.25;
  story.scan_period_ns = 25'000'000;  // what the lines say
  story.true_period_ns = 25'040'000;  // 640 lines are more than a line longer
  Stage stage;
  stage.add(story.axis());
  stage.add(story.cruising());
  for (int index = 0; index < 640; ++index) {
    if (index != 630) stage.add(story.line(index));
  }
  ASSERT_EQ(stage.sweeps.size(), 1U);
  EXPECT_EQ(stage.sweeps[0].sweep.lines_missing(), 1U);
  EXPECT_TRUE(stage.sweeps[0].cloud.line_missing(630));
  expect_same(stage.sweeps[0].cloud, expected_cloud(story, {630}));
}

TEST(Assembler, AGeometrySetAnewIsThatOfTheNextSweep) {
  const Story first;
  Story second;
  second.sweep_id = 8;
  second.first_beam_ns += 5'000 * kMillisecondNs;
  AssemblyOptions other = story_options();
  other.geometry = RigGeometry();
  Stage stage(other);
  stage.add(first.axis());
  stage.add(first.cruising());
  stage.add_lines(first, 0, 6);
  stage.assembler.set_geometry(story_geometry());
  stage.add_lines(first, 6, 12);
  stage.add(second.axis());
  stage.add(second.cruising());
  stage.add_lines(second, 0, 12);
  ASSERT_EQ(stage.sweeps.size(), 2U);
  expect_same(stage.sweeps[1].cloud, expected_cloud(second));
  EXPECT_NE(stage.sweeps[0].cloud.line(11)[3].x_m, stage.sweeps[1].cloud.line(11)[3].x_m);
  const CloudPoint& row0 = stage.sweeps[0].cloud.line(0)[3];
  EXPECT_NEAR(row0.x_m, 2.513 * std::sin(0.0), 0.05);  // the identity's: no lever arm, no tilt
}

}  // namespace
}  // namespace swivel
