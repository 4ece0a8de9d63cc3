#include "components/recording/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "recording_files.hpp"

namespace swivel {
namespace {

struct Played {
  RecordingFacts facts;
  std::vector<msg::ScanLine> lines;
  std::vector<msg::AxisSample> axis;
  std::vector<msg::Sweep> sweeps;
};

// Plays to the end, and checks what holds for every recording.
Played play(const std::string& path) {
  auto recording = Recording::open(path, "test_rig");
  EXPECT_TRUE(recording) << recording.reason();
  if (!recording) return {};
  Played played{recording->facts(), {}, {}, {}};
  std::int64_t time_ns = INT64_MIN;
  while (true) {
    auto event = recording->next();
    EXPECT_TRUE(event) << event.reason();
    if (!event || !event->has_value()) break;
    EXPECT_GE((*event)->time_ns, time_ns) << "events must be in order of time";
    time_ns = (*event)->time_ns;
    if (auto* line = std::get_if<msg::ScanLine>(&(*event)->message)) {
      EXPECT_EQ(line->rig(), "test_rig");
      EXPECT_EQ(line->ranges_mm().size(), played.facts.beams);
      played.lines.push_back(std::move(*line));
    } else if (auto* axis = std::get_if<msg::Axis>(&(*event)->message)) {
      EXPECT_EQ(axis->source() == msg::AXIS_MEASURED, played.facts.axis_measured);
      for (const auto& sample : axis->samples()) {
        const bool later = played.axis.empty() || sample.time_ns() > played.axis.back().time_ns();
        EXPECT_TRUE(later) << "samples must be in order of time";
        played.axis.push_back(sample);
      }
    } else {
      played.sweeps.push_back(std::get<msg::Sweep>((*event)->message));
    }
  }
  EXPECT_EQ(played.lines.size(), played.facts.lines);
  return played;
}

double angle_at(const std::vector<msg::AxisSample>& axis, double time_ns) {
  for (std::size_t sample = 1; sample < axis.size(); ++sample) {
    const auto start_ns = static_cast<double>(axis[sample - 1].time_ns());
    const auto end_ns = static_cast<double>(axis[sample].time_ns());
    if (time_ns < start_ns || time_ns > end_ns) continue;
    const double part = (time_ns - start_ns) / (end_ns - start_ns);
    return axis[sample - 1].angle_deg() +
           part * (axis[sample].angle_deg() - axis[sample - 1].angle_deg());
  }
  return std::nan("");
}

double last_beam_ns(const msg::ScanLine& line) {
  return static_cast<double>(line.beam0_time_ns()) +
         static_cast<double>(line.ranges_mm().size() - 1) * line.beam_period_ns();
}

std::vector<const msg::ScanLine*> lines_in_window(const Played& played, const msg::Sweep& sweep) {
  std::vector<const msg::ScanLine*> lines;
  for (const auto& line : played.lines) {
    if (line.beam0_time_ns() >= sweep.window_start_ns() &&
        last_beam_ns(line) <= static_cast<double>(sweep.window_end_ns()))
      lines.push_back(&line);
  }
  return lines;
}

std::map<std::string, std::string> truth_of(const std::string& name) {
  std::map<std::string, std::string> truth;
  for (const std::string& line : lines_of(read_file(test_recording(name) + "/truth.csv")))
    truth[line.substr(0, line.find(','))] = line.substr(line.find(',') + 1);
  return truth;
}

std::uint16_t uint16_at(const std::string& bytes, std::size_t index) {
  const auto low = static_cast<unsigned char>(bytes[2 * index]);
  const auto high = static_cast<unsigned char>(bytes[2 * index + 1]);
  return static_cast<std::uint16_t>(low + 256 * high);
}

TEST(PlateCase, SaysWhatItsMetaSays) {
  const Played played = play(test_recording("plate_period"));
  EXPECT_EQ(played.facts.suggested_rig, "yuan");
  EXPECT_FALSE(played.facts.axis_measured);
  EXPECT_EQ(played.facts.modes, (std::vector<int>{1, 1}));
  EXPECT_EQ(played.facts.lines, 80U);
  ASSERT_TRUE(played.facts.plate);
  EXPECT_EQ(played.facts.plate->alpha_deg, 30.0);
  EXPECT_EQ(played.facts.plate->lever_arm_m, 0.0139);
  EXPECT_EQ(played.facts.plate->depth_m, 0.060935);
  EXPECT_EQ(played.lines[0].first_beam_angle_deg(), -135.0);
  EXPECT_EQ(played.lines[0].range_min_mm(), 60);
  EXPECT_EQ(played.lines[0].range_max_mm(), 10000);
}

TEST(PlateCase, TheTruePeriodIsFoundFromTheStamps) {
  const Played played = play(test_recording("plate_period"));
  const double true_period_ns = std::stod(truth_of("plate_period")["sweep0_period_s"]) * 1e9;
  ASSERT_GT(std::abs(true_period_ns / 25e6 - 1.0), 2e-3);
  // Two sweeps of mode 1: 2e-4 of 180 deg is 0.036 deg.
  EXPECT_NEAR(played.facts.scan_period_ns / true_period_ns, 1.0, 2e-4);
  EXPECT_NEAR(played.lines[0].beam_period_ns() * 1440.0, played.facts.scan_period_ns, 1e-3);
}

TEST(PlateCase, TheCommandedAxisTurnsAsTheShaftDid) {
  const Played played = play(test_recording("plate_period"));
  const auto truth = lines_of(read_file(test_recording("plate_period") + "/truth_lines.csv"));
  ASSERT_EQ(truth.size(), played.lines.size() + 1);
  double start_deg = 0.0;
  for (std::size_t line = 0; line < played.lines.size(); ++line) {
    const double phi_deg = std::stod(truth[line + 1].substr(truth[line + 1].rfind(',') + 1));
    if (line % 40 == 0) start_deg = phi_deg;
    const auto time_ns = static_cast<double>(played.lines[line].beam0_time_ns());
    EXPECT_NEAR(angle_at(played.axis, time_ns), phi_deg - start_deg, 0.04) << "line " << line;
  }
}

TEST(PlateCase, TheWindowHoldsTheSweepsLinesAndNoOther) {
  const Played played = play(test_recording("plate_period"));
  ASSERT_EQ(played.sweeps.size(), 6U);
  for (std::size_t sweep = 0; sweep < 2; ++sweep) {
    const msg::Sweep& cruising = played.sweeps[3 * sweep];
    EXPECT_EQ(cruising.phase(), msg::PHASE_CRUISING);
    EXPECT_EQ(cruising.sweep_id(), sweep + 1);
    EXPECT_EQ(cruising.lines_expected(), 40U);
    EXPECT_EQ(cruising.sweeps_left(), 1 - sweep);
    const auto lines = lines_in_window(played, cruising);
    ASSERT_EQ(lines.size(), 40U);
    EXPECT_EQ(lines.front(), &played.lines[40 * sweep]);
    for (const auto* line : lines)
      EXPECT_FALSE(std::isnan(angle_at(played.axis, last_beam_ns(*line))));
    EXPECT_EQ(played.sweeps[3 * sweep + 1].phase(), msg::PHASE_DECELERATING);
    EXPECT_EQ(played.sweeps[3 * sweep + 2].phase(), msg::PHASE_IDLE);
  }
}

TEST(PlateCase, RangesAndIntensitiesAreThoseOfTheFiles) {
  const Played played = play(test_recording("plate_period"));
  const std::string ranges = read_file(test_recording("plate_period") + "/ranges.u16");
  const std::string intensities = read_file(test_recording("plate_period") + "/intensity.u16");
  for (std::size_t reading = 0; reading < 80U * 1081U; ++reading) {
    const msg::ScanLine& line = played.lines[reading / 1081];
    const std::uint16_t range_mm = uint16_at(ranges, reading);
    ASSERT_EQ(line.ranges_mm()[reading % 1081], range_mm == 0 ? 65533 : range_mm);
    ASSERT_EQ(line.intensities()[reading % 1081], uint16_at(intensities, reading));
  }
}

TEST(PlateCase, AMissingLineIsAHoleAndMovesNoOther) {
  const ScratchFolder scratch;
  scratch.copy_case("plate_period");
  auto lines = lines_of(read_file(scratch.file("lines.csv")));
  lines.erase(lines.begin() + 1 + 17);
  write_file(scratch.file("lines.csv"), joined(lines));
  for (const char* name : {"ranges.u16", "intensity.u16"}) {
    const std::string bytes = read_file(scratch.file(name));
    write_file(scratch.file(name), bytes.substr(0, 17 * 2162) + bytes.substr(18 * 2162));
  }
  const Played whole = play(test_recording("plate_period")), holed = play(scratch.path());
  ASSERT_EQ(holed.lines.size(), 79U);
  EXPECT_EQ(holed.lines[16].sequence_number(), 17U);
  EXPECT_EQ(holed.lines[17].sequence_number(), 19U);
  EXPECT_EQ(holed.sweeps[0].lines_expected(), 40U);
  EXPECT_EQ(holed.lines[17].ranges_mm(), whole.lines[18].ranges_mm());
  EXPECT_NEAR(static_cast<double>(holed.lines[17].beam0_time_ns()),
              static_cast<double>(whole.lines[18].beam0_time_ns()), 50e3);
}

TEST(PlateCase, TheCounterMayWrapInsideASweep) {
  const ScratchFolder scratch;
  scratch.copy_case("plate_period");
  auto lines = lines_of(read_file(scratch.file("lines.csv")));
  for (std::size_t line = 1; line < lines.size(); ++line) {
    const auto start = lines[line].find(',', lines[line].find(',') + 1) + 1;
    const auto length = lines[line].find(',', start) - start;
    const long stamp_ms = std::stol(lines[line].substr(start, length));
    lines[line].replace(start, length, std::to_string((stamp_ms + 16777216 - 13000) % 16777216));
  }
  write_file(scratch.file("lines.csv"), joined(lines));
  const Played plain = play(test_recording("plate_period")), wrapped = play(scratch.path());
  ASSERT_EQ(wrapped.lines.size(), plain.lines.size());
  ASSERT_GT(wrapped.lines[0].device_stamp_ms(), wrapped.lines[39].device_stamp_ms());
  for (std::size_t line = 0; line < plain.lines.size(); ++line)
    EXPECT_EQ(wrapped.lines[line].beam0_time_ns(), plain.lines[line].beam0_time_ns());
}

TEST(PanCase, EachLineHasItsMeasuredAngle) {
  const Played played = play(test_recording("pan_sparse"));
  EXPECT_EQ(played.facts.suggested_rig, "zeng");
  EXPECT_TRUE(played.facts.axis_measured);
  EXPECT_FALSE(played.facts.plate);
  EXPECT_EQ(played.facts.modes, std::vector<int>{0});
  const auto rows = lines_of(read_file(test_recording("pan_sparse") + "/lines.csv"));
  for (std::size_t line = 0; line < played.lines.size(); ++line) {
    const double pan_deg = std::stod(rows[line + 1].substr(rows[line + 1].rfind(',') + 1));
    const auto first_ns = static_cast<double>(played.lines[line].beam0_time_ns());
    EXPECT_NEAR(angle_at(played.axis, first_ns), pan_deg, 1e-9);
    EXPECT_NEAR(angle_at(played.axis, last_beam_ns(played.lines[line])), pan_deg, 1e-9);
  }
  EXPECT_EQ(lines_in_window(played, played.sweeps[0]).size(), 36U);
}

TEST(TiltingCsv, ARunUpAndARunDownAreTwoSweeps) {
  const Played played = play(test_recording("tilting_room_turning.csv.gz"));
  EXPECT_EQ(played.facts.suggested_rig, "tilting");
  ASSERT_EQ(played.facts.modes, (std::vector<int>{0, 0}));
  const auto up = lines_in_window(played, played.sweeps[0]);
  const auto down = lines_in_window(played, played.sweeps[3]);
  EXPECT_GT(played.sweeps[0].speed_deg_s(), 0.5);
  EXPECT_LT(played.sweeps[3].speed_deg_s(), -0.5);
  // The line at which the axis turns back, and the last, of which nobody knows: in no sweep.
  EXPECT_EQ(up.size() + down.size() + 1, played.lines.size());
  EXPECT_GT(up.size(), 20U);
  EXPECT_GT(down.size(), 20U);
}

TEST(TiltingCsv, TheAngleIsThatOfTheFileAtEachStampAndLinearBetween) {
  const std::string path = test_recording("tilting_box_start.csv.gz");
  const Played played = play(path);
  const auto rows = lines_of(unzipped(path));
  for (std::size_t line = 0; line < played.lines.size(); ++line) {
    std::istringstream row(rows[line + 3]);
    std::string stamp_ns, angle_deg;
    std::getline(std::getline(row, stamp_ns, ';'), angle_deg, ';');
    ASSERT_EQ(played.lines[line].beam0_time_ns(), std::stoll(stamp_ns));
    const auto time_ns = static_cast<double>(std::stoll(stamp_ns));
    EXPECT_NEAR(angle_at(played.axis, time_ns), std::stod(angle_deg), 1e-3);
    if (line + 1 == played.lines.size()) break;
    const double between = angle_at(played.axis, time_ns + 30e6);
    EXPECT_GT(between, std::stod(angle_deg) + 0.015);
    EXPECT_LT(between, std::stod(angle_deg) + 0.03);
  }
}

TEST(TiltingCsv, AScanThatWasDroppedIsAHoleInTheSequence) {
  const Played played = play(test_recording("tilting_room_turning.csv.gz"));
  for (std::size_t line = 1; line < played.lines.size(); ++line) {
    const auto since_ns =
        played.lines[line].beam0_time_ns() - played.lines[line - 1].beam0_time_ns();
    const auto step =
        played.lines[line].sequence_number() - played.lines[line - 1].sequence_number();
    EXPECT_EQ(step, since_ns > 150'000'000 ? 2U : 1U) << "line " << line;
  }
}

TEST(CorridorCsv, WithoutAnAxisThereAreScanLinesOnly) {
  const std::string path = test_recording("corridor.csv.gz");
  const Played played = play(path);
  EXPECT_EQ(played.facts.suggested_rig, "");
  EXPECT_NE(played.facts.remark, "");
  EXPECT_TRUE(played.axis.empty());
  EXPECT_TRUE(played.sweeps.empty());
  ASSERT_EQ(played.lines.size(), 20U);
  const auto rows = lines_of(unzipped(path));
  for (std::size_t line = 0; line < played.lines.size(); ++line) {
    std::istringstream row(rows[line + 3]);
    std::string skipped, ranges, intensities;
    for (std::string* field : {&skipped, &skipped, &ranges, &intensities})
      std::getline(row, *field, ';');
    std::istringstream range_words(ranges), intensity_words(intensities);
    for (std::size_t beam = 0; beam < played.facts.beams; ++beam) {
      int range_mm = 0, intensity = 0;
      range_words >> range_mm;
      intensity_words >> intensity;
      ASSERT_EQ(played.lines[line].ranges_mm()[beam], range_mm == 0 ? 65533 : range_mm);
      ASSERT_EQ(played.lines[line].intensities()[beam], intensity);
    }
  }
  EXPECT_NEAR(played.facts.scan_period_ns, 25.04e6, 0.05e6);
  EXPECT_NEAR(played.lines[0].beam_period_ns(), 25e6 / 1440.0, 1.0);
}

}  // namespace
}  // namespace swivel
