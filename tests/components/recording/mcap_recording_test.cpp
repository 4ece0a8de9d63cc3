// A recording of a live rig gives the messages that were recorded, and no others.
#include "components/recording/mcap_recording.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "components/mcap/writer.hpp"
#include "recording_files.hpp"
#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

std::vector<RecordedEvent> events_in(const std::string& path) {
  std::vector<RecordedEvent> events;
  auto recording = Recording::open(path, "attic");
  EXPECT_TRUE(recording) << recording.reason();
  if (!recording) return events;
  while (true) {
    auto event = recording->next();
    EXPECT_TRUE(event) << event.reason();
    if (!event || !event->has_value()) return events;
    events.push_back(std::move(**event));
  }
}

class McapRecording : public testing::Test {
 protected:
  ~McapRecording() override {
    for (const std::string& left : {path_, part_of(path_)}) std::filesystem::remove(left);
  }

  template <class Message>
  void write(const Topic<Message>& topic, const Message& message) {
    const std::string name = topic.full_name("attic");
    if (ids_.count(name) == 0) ids_[name] = *writer_->add_channel({name, "cdr", {}, {}});
    time_ns_ += 1000;
    EXPECT_TRUE(writer_->write({ids_[name], 1, time_ns_, time_ns_, encode_cdr(message)}));
  }
  void write(const msg::ScanLine& line) { write(kScanLineTopic, line); }
  void write(const msg::Axis& axis) { write(kAxisTopic, axis); }
  void write(const msg::Sweep& sweep) { write(kSweepTopic, sweep); }
  void write(const msg::Calibration& calibration) { write(kCalibrationTopic, calibration); }

  void write_case() {
    for (const RecordedEvent& event : original_)
      std::visit([this](const auto& message) { write(message); }, event.message);
  }
  static msg::Sweep sweep(msg::SweepPhase phase, std::uint64_t id) {
    msg::Sweep sweep;
    sweep.phase(phase);
    sweep.sweep_id(id);
    sweep.window_start_ns(1000);  // long before any line
    sweep.window_end_ns(2000);
    return sweep;
  }

  const std::string path_ = own_path("recording.mcap");
  const std::vector<RecordedEvent> original_ = events_in(test_recording("plate_period"));
  Result<McapWriter> writer_ = McapWriter::create(path_);
  std::map<std::string, std::uint16_t> ids_;
  std::int64_t time_ns_ = 1'700'000'000'000'000'000;
};

TEST_F(McapRecording, GivesTheVeryMessages) {
  write_case();
  ASSERT_TRUE(writer_->close());
  const auto events = events_in(path_);
  ASSERT_EQ(events.size(), original_.size());
  for (std::size_t i = 0; i < events.size(); ++i)
    EXPECT_TRUE(events[i].message == original_[i].message) << i;

  const auto recording = Recording::open(path_);
  const auto of_case = Recording::open(test_recording("plate_period"));
  EXPECT_EQ(recording->facts().rig, "attic");
  EXPECT_EQ(recording->facts().modes, of_case->facts().modes);
  EXPECT_EQ(recording->facts().lines, of_case->facts().lines);
  EXPECT_EQ(recording->facts().beams, of_case->facts().beams);
  EXPECT_EQ(recording->facts().axis_measured, of_case->facts().axis_measured);
}

TEST_F(McapRecording, LeavesOutWhatTheStagesMadeAndSweepsFromBeforeItBegan) {
  write(sweep(msg::PHASE_CRUISING, 1'000'000));
  write(sweep(msg::PHASE_IDLE, 1'000'000));
  msg::Calibration calibration;
  calibration.alpha_deg(29.5);
  write(calibration);
  write_case();
  write(sweep(msg::PHASE_ASSEMBLED, 1));
  write(kAttitudeTopic, msg::Attitude());
  write(kRawCloudTopic, PointCloud2());
  ASSERT_TRUE(writer_->close());
  const auto events = events_in(path_);
  ASSERT_EQ(events.size(), original_.size() + 1);
  EXPECT_EQ(std::get<msg::Calibration>(events[0].message), calibration);
  EXPECT_EQ(Recording::open(path_)->facts().modes.size(), 2U);
}

TEST_F(McapRecording, WithoutItsEndIsRefusedWithWhatToDo) {
  write_case();
  ASSERT_TRUE(writer_->end_chunk());
  const auto recording = Recording::open(part_of(path_));
  ASSERT_FALSE(recording);
  EXPECT_THAT(recording.reason(), HasSubstr("swivel recover"));
}

TEST_F(McapRecording, OfCloudsAloneSaysWhatItLacks) {
  write(kRawCloudTopic, PointCloud2());
  ASSERT_TRUE(writer_->close());
  EXPECT_THAT(Recording::open(path_)->facts().remark, HasSubstr("scan_line"));
}

}  // namespace
}  // namespace swivel
