// swivel info, check, recover and slice, as a user runs them.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "components/mcap/reader.hpp"
#include "components/mcap/writer.hpp"
#include "run_swivel.hpp"
#include "scratch_folder.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

class McapVerbs : public testing::Test {
 protected:
  // A calibration, then ten seconds of lines, ten a second, a chunk a second. Line 57 never came.
  McapVerbs() {
    auto writer = McapWriter::create(path_);
    const auto lines = writer->add_channel({"rig/scan_line", "cdr", {}, {}});
    const auto calibration = writer->add_channel({"rig/calibration", "cdr", {}, {}});
    EXPECT_TRUE(writer->write({*calibration, 1, kStart_ns, kStart_ns, "calibration"}));
    for (std::uint32_t line = 0; line < 100; ++line) {
      const std::int64_t time_ns = kStart_ns + line * std::int64_t{100'000'000};
      if (line == 57) continue;
      EXPECT_TRUE(writer->write({*lines, line, time_ns, time_ns - 30'000'000, "line"}));
      EXPECT_TRUE(line % 10 != 9 || writer->end_chunk());
    }
    EXPECT_TRUE(writer->close());
  }

  nlohmann::json info(const std::string& path) const {
    EXPECT_EQ(run_swivel(scratch_, "info --json " + path), 0);
    return nlohmann::json::parse(content_of(scratch_.file("out")), nullptr, false);
  }

  const ScratchFolder scratch_;
  const std::string path_ = scratch_.file("recording.mcap");
  const std::string other_ = scratch_.file("other.mcap");
};

TEST_F(McapVerbs, InfoTellsWhatIsThereAndWhatIsMissing) {
  const auto json = info(path_);
  EXPECT_EQ(json["messages"], 100);
  EXPECT_EQ(json["missing"], 1);
  EXPECT_EQ(json["closed"], true);
  EXPECT_NEAR(json["duration_s"], 9.9, 1e-6);
  EXPECT_NEAR(json["channels"][1]["longest_pause_s"], 0.2, 1e-6);
  EXPECT_EQ(run_swivel(scratch_, "check " + path_), 65);
}

// A file of another's may bear any words.
TEST_F(McapVerbs, InfoOfWordsThatAreNotUtf8IsJsonAllTheSame) {
  {
    auto writer = McapWriter::create(other_);
    const auto channel = writer->add_channel({"rig/\xff\xfe", "\x80", {}, {}});
    EXPECT_TRUE(writer->write({*channel, 1, kStart_ns, kStart_ns, "x"}));
    EXPECT_TRUE(writer->close());
  }
  EXPECT_EQ(info(other_)["messages"], 1);
}

TEST_F(McapVerbs, WhatIsCutIsRecoveredToItsLastWholeChunk) {
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 3);
  EXPECT_EQ(run_swivel(scratch_, "check " + path_), 65);
  ASSERT_EQ(run_swivel(scratch_, "recover " + path_ + " -o " + other_), 0);
  EXPECT_THAT(content_of(scratch_.file("out")), HasSubstr("messages are in"));
  const auto json = info(other_);
  EXPECT_EQ(json["messages"].get<int>() % 10, 1) << "whole seconds, and the calibration";
  EXPECT_GT(json["messages"], 10);
  EXPECT_EQ(run_swivel(scratch_, "check " + other_), 0);
  EXPECT_EQ(run_swivel(scratch_, "recover " + path_ + " -o " + other_), 73) << "written over";
}

TEST_F(McapVerbs, ASliceHasItsSecondsAndTheCalibrationThatStandsInThem) {
  ASSERT_EQ(run_swivel(scratch_, "slice " + path_ + " --from 2 --to 4 -o " + other_), 0);
  auto reader = McapReader::open(other_);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->next()->data, "calibration");
  for (std::uint32_t line = 20; line < 40; ++line) EXPECT_EQ(reader->next()->sequence, line);
  EXPECT_FALSE(reader->next());
}

// In the last byte of a message, where only the sum can see it.
TEST_F(McapVerbs, CheckSeesAFlippedBit) {
  std::string bytes = content_of(path_);
  bytes[bytes.rfind("line", bytes.size() - 600) + 3] ^= 1;
  std::ofstream(path_, std::ios::binary) << bytes;
  EXPECT_EQ(run_swivel(scratch_, "check " + path_), 65);
  EXPECT_THAT(content_of(scratch_.file("out")), HasSubstr("sum"));
}

TEST_F(McapVerbs, HzTellsTheRateAndTheLongestWait) {
  ASSERT_EQ(run_swivel(scratch_, "hz --json " + path_ + " scan_line"), 0);
  const auto json = nlohmann::json::parse(content_of(scratch_.file("out")))["rig/scan_line"];
  EXPECT_EQ(json["messages"], 99);
  EXPECT_NEAR(json["rate_hz"], 98 / 9.9, 1e-6);
  EXPECT_NEAR(json["interval_ms"]["largest"], 200.0, 1e-3);
  EXPECT_NEAR(json["delay_ms"]["largest"], 30.0, 1e-3);
}

TEST_F(McapVerbs, EchoDoesNotMakeSenseOfWhatHasNone) {
  EXPECT_EQ(run_swivel(scratch_, "echo --json " + path_), 65);
  EXPECT_THAT(content_of(scratch_.file("err")), HasSubstr("100 messages could not be decoded"));
}

TEST_F(McapVerbs, SayWhyAFileCannotBeRead) {
  EXPECT_EQ(run_swivel(scratch_, "info " + scratch_.file("nothing.mcap")), 66);
  std::ofstream(other_) << "stamp_ns;axis_angle_deg\n";
  EXPECT_EQ(run_swivel(scratch_, "info " + other_), 65);
  EXPECT_THAT(content_of(scratch_.file("err")), HasSubstr("no MCAP file"));
  EXPECT_EQ(run_swivel(scratch_, "replay --max --topics cloud --wait-s 0 " + path_), 69);
}

}  // namespace
}  // namespace swivel
