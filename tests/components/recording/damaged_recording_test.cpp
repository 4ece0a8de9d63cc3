// Whatever is wrong with a recording: an error that names the file, never a crash.
#include <gmock/gmock.h>

#include <ostream>

#include "components/recording/recording.hpp"
#include "recording_files.hpp"

namespace swivel {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

// The reason; where there is none, what the lines hold.
std::string opened(const std::string& path) {
  auto recording = Recording::open(path);
  if (!recording) return recording.reason();
  std::size_t lines = 0, readings = 0;
  while (true) {
    auto event = recording->next();
    if (!event) return event.reason();
    if (!event->has_value())
      return std::to_string(lines) + " lines, hash " + std::to_string(readings);
    const auto* const line = std::get_if<msg::ScanLine>(&(*event)->message);
    if (line == nullptr) continue;
    ++lines;
    for (const std::uint16_t range_mm : line->ranges_mm()) readings = readings * 31 + range_mm;
    readings += static_cast<std::size_t>(line->beam0_time_ns());
  }
}

struct Damage {
  const char* file;
  const char* from;
  const char* to;
  const char* words;  // that the reason must hold
};

std::ostream& operator<<(std::ostream& out, const Damage& damage) {
  return out << damage.file << ": '" << damage.from << "' -> '" << damage.to << "'";
}

class DamagedCase : public testing::TestWithParam<Damage> {};

TEST_P(DamagedCase, IsAnErrorThatNamesTheFile) {
  const ScratchFolder scratch;
  scratch.copy_case("plate_period");
  const std::string path = scratch.file(GetParam().file);
  write_file(path, replaced(read_file(path), GetParam().from, GetParam().to));
  EXPECT_THAT(opened(scratch.path()),
              AllOf(HasSubstr(scratch.path()), HasSubstr(GetParam().words)));
}

INSTANTIATE_TEST_SUITE_P(
    Meta, DamagedCase,
    testing::Values(Damage{"meta.csv", "period_s,0.025\n", "", "meta.csv: period_s"},
                    Damage{"meta.csv", "rig,plate\n", "", "meta.csv: rig"},
                    Damage{"meta.csv", "rig,plate", "rig,crane", "meta.csv: rig"},
                    Damage{"meta.csv", "sweeps,2\n", "sweeps,2\nsweeps,3\n", "meta.csv:12"},
                    Damage{"meta.csv", "sweeps,2", "sweeps 2", "meta.csv:11"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,many", "meta.csv: n_beams"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,1081x", "meta.csv: n_beams"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,-1081", "meta.csv: n_beams"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,0", "meta.csv: n_beams"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,1e300", "meta.csv: n_beams"},
                    Damage{"meta.csv", "n_beams,1081", "n_beams,1080", "ranges.u16: has"},
                    Damage{"meta.csv", "period_s,0.025", "period_s,nan", "meta.csv: period_s"},
                    Damage{"meta.csv", "period_s,0.025", "period_s,0.05", "lines.csv: "},
                    Damage{"meta.csv", "first_deg,-135.0", "first_deg,inf", "meta.csv: first_deg"},
                    Damage{"meta.csv", "sweeps,2", "sweeps,4294967297", "meta.csv: sweeps"},
                    Damage{"meta.csv", "sweeps,2", "sweeps,-1", "meta.csv: sweeps"},
                    Damage{"meta.csv", "sweeps,2", "sweeps,3", "meta.csv: lines_per_sweep"},
                    Damage{"meta.csv", "40 40", "40 1000000", "meta.csv: lines_per_sweep"},
                    Damage{"meta.csv", "40 40", "40 39", "lines.csv:81"},
                    Damage{"meta.csv", "range_max_m,10.0", "range_max_m,0.01", "range_max_m"},
                    Damage{"meta.csv", "range_max_m,10.0", "range_max_m,70", "range_max_m"},
                    Damage{"meta.csv", "sequence,improved", "sequence,new", "sequence"},
                    Damage{"meta.csv", "180.0 180.0", "180.0 fast", "motor_speed_deg_s"}));

INSTANTIATE_TEST_SUITE_P(
    Lines, DamagedCase,
    testing::Values(Damage{"lines.csv", "sweep,line", "line,sweep", "lines.csv:1:"},
                    Damage{"lines.csv", "0,2,", "0,1,", "lines.csv:4"},
                    Damage{"lines.csv", "0,2,", "-1,2,", "lines.csv:4"},
                    Damage{"lines.csv", "0,2,", "0,two,", "lines.csv:4"},
                    Damage{"lines.csv", "0,2,", "0,2,,", "lines.csv:4"},
                    Damage{"lines.csv", "0,2,", "0,4000000000,", "lines.csv:4"},
                    Damage{"lines.csv", "0,0,", "1,0,", "lines.csv:2"},
                    Damage{"lines.csv", "0,0,12672", "0,0,-12672", "lines.csv:2"},
                    Damage{"lines.csv", "0,0,12672", "0,0,16777216", "lines.csv:2"},
                    Damage{"lines.csv", "0,0,12672", "0,0,14672", "lines.csv: the lidar's"},
                    Damage{"lines.csv", "0,2,12722", "0,2,12742", "sweep 0, line 2"},
                    Damage{"lines.csv", "0,0,12672,0.348226", "0,0,12672,nan", "lines.csv:2"},
                    Damage{"lines.csv", "0,0,12672,0.348226", "0,0,12672,1e200", "lines.csv:2"},
                    Damage{"lines.csv", "0.348226,", "0.348226,1.5", "lines.csv:2"},
                    Damage{"lines.csv", "1,0,32658,20.334082", "1,0,32658,0.5", "host_s"}));

TEST(DamagedCaseFiles, AFileThatIsMissing) {
  for (const char* name : {"meta.csv", "lines.csv", "ranges.u16", "intensity.u16"}) {
    const ScratchFolder scratch;
    scratch.copy_case("pan_sparse");
    std::filesystem::remove(scratch.file(name));
    EXPECT_THAT(opened(scratch.path()), AllOf(HasSubstr(name), HasSubstr("no such file")));
  }
}

TEST(DamagedCaseFiles, AFileCutAtAnyLength) {
  const std::string whole_case = opened(test_recording("pan_sparse"));  // a key that nobody needs
  for (const char* name : {"meta.csv", "lines.csv", "ranges.u16", "intensity.u16"}) {
    const ScratchFolder scratch;
    scratch.copy_case("pan_sparse");
    const std::string whole = read_file(scratch.file(name));
    const std::size_t step = 1 + whole.size() / 60;
    for (std::size_t length = 0; length + step < whole.size(); length += step) {
      write_file(scratch.file(name), whole.substr(0, length));
      EXPECT_THAT(opened(scratch.path()), AnyOf(HasSubstr(scratch.path()), whole_case))
          << name << " at " << length;
    }
  }
}

TEST(DamagedCsvFiles, NoSuchFile) {
  EXPECT_THAT(opened("/nowhere/recording.csv.gz"), HasSubstr("no such file"));
}

TEST(DamagedCsvFiles, CutAtAnyLength) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("cut.csv.gz");
  const std::string whole = read_file(test_recording("tilting_box_start.csv.gz"));
  for (std::size_t length = 0; length < whole.size(); length += 173) {
    write_file(path, whole.substr(0, length));
    EXPECT_THAT(opened(path), HasSubstr(path + ":")) << "at " << length;
  }
  write_file(path, whole.substr(0, whole.size() - 1));
  EXPECT_THAT(opened(path), HasSubstr(path + ":"));
}

TEST(DamagedCsvFiles, AFlippedBitNeverChangesAReading) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("flipped.csv.gz");
  const std::string whole = read_file(test_recording("tilting_box_start.csv.gz"));
  write_file(path, whole);
  const std::string unspoilt = opened(path);
  for (std::size_t place = 0; place < whole.size(); place += 97) {
    std::string flipped = whole;
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << (place % 8)));
    write_file(path, flipped);
    EXPECT_THAT(opened(path), AnyOf(HasSubstr(path + ":"), unspoilt)) << "at " << place;
  }
}

class DamagedCsv : public testing::TestWithParam<Damage> {};

TEST_P(DamagedCsv, IsAnErrorThatNamesTheLine) {
  const ScratchFolder scratch;
  const std::string path = scratch.file(GetParam().file);
  const std::string whole = unzipped(test_recording("tilting_box_start.csv.gz"));
  write_file(path, replaced(whole, GetParam().from, GetParam().to));
  EXPECT_THAT(opened(path), AllOf(HasSubstr(path), HasSubstr(GetParam().words)));
}

INSTANTIATE_TEST_SUITE_P(
    Header, DamagedCsv,
    testing::Values(Damage{"a.csv", "beams: 512", "beans: 512", "beams"},
                    Damage{"a.csv", "beams: 512", "beams: -512", "beams"},
                    Damage{"a.csv", "beams: 512", "beams: 1e9", "beams"},
                    Damage{"a.csv", "beams: 512", "beams: 511", "a.csv:4: expected 511 ranges"},
                    Damage{"a.csv", "beams: 512", "beams: 513", "a.csv:4: expected 513 ranges"},
                    Damage{"a.csv", "scan_time_s: 0.1", "scan_time_s: nan", "scan_time_s"},
                    Damage{"a.csv", "scan_time_s: 0.1", "scan_time_s: 0", "scan_time_s"},
                    Damage{"a.csv", "scan_time_s: 0.1", "scan_time_s: 0.01", "take longer"},
                    Damage{"a.csv", "increment_s: 9.7", "increment_s: -9.7", "time_increment_s"},
                    Damage{"a.csv", "range_max_m: 5", "range_max_m: 99", "range_max_m"}));

INSTANTIATE_TEST_SUITE_P(
    Rows, DamagedCsv,
    testing::Values(
        Damage{"a.csv", "1436203604914450500;0.15;", "1436203604914450500;0.15", "a.csv:5:"},
        Damage{"a.csv", "1436203604914450500;", "-5;", "a.csv:5:"},
        Damage{"a.csv", "1436203604914450500;", "99999999999999999999999;", "a.csv:5:"},
        Damage{"a.csv", "1436203604914450500;", "1436203604814176501;", "a.csv:5:"},
        Damage{"a.csv", "1436203604914450500;", "1;", "a.csv:5:"},
        Damage{"a.csv", "500;0.15;", "500;up;", "a.csv:5: the axis"},
        Damage{"a.csv", "500;0.15;", "500;nan;", "a.csv:5: the axis"},
        Damage{"a.csv", "500;0.15;", "500;;", "a.csv:5: the axis"},
        Damage{"a.csv", ";0.15;178 ", ";0.15;65536 ", "a.csv:5: expected 512 ranges"},
        Damage{"a.csv", ";0.15;178 ", ";0.15;-178 ", "a.csv:5: expected 512 ranges"},
        Damage{"a.csv", ";0.15;178 ", ";0.15;17.8 ", "a.csv:5: expected 512 ranges"},
        Damage{"a.csv", ";0.15;178 ", ";0.15;178  ", "a.csv:5: expected 512 ranges"},
        Damage{"a.csv", "\n1436203604914450500", "7\n1436203604914450500",
               "a.csv:4: expected no int"},
        Damage{"a.csv", "\n1436203604914450500", "\n\n1436203604914450500", "a.csv:5:"}));

TEST(DamagedCsvFiles, ALineWithoutEndAndAZeroByte) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("long.csv");
  write_file(path, "# " + std::string(5'000'000, 'x') + "\n");
  EXPECT_THAT(opened(path), HasSubstr(path + ":1: the line is too long"));
  write_file(path, std::string("# beams: 5\0 12\n", 15) + "more\n");
  EXPECT_THAT(opened(path), HasSubstr(path + ":1:"));
}

TEST(DamagedCsvFiles, AStampFarInTheFutureMakesNoHugeSweep) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("late.csv");
  auto lines = lines_of(unzipped(test_recording("tilting_box_start.csv.gz")));
  lines.back().replace(0, 19, "4436203604914450500");
  write_file(path, joined(lines));
  EXPECT_THAT(opened(path), HasSubstr("60 lines"));
}

}  // namespace
}  // namespace swivel
