// The recorder at its limits: what does not reach the file is counted, and said.
#include "components/swivel/recorder/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include "components/common/program.hpp"
#include "components/mcap/reader.hpp"
#include "components/swivel/recorder/topics_named.hpp"
#include "scratch_folder.hpp"
#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

class RecorderTest : public testing::Test {
 protected:
  RecorderOptions options() const {
    RecorderOptions options;
    options.path = scratch_.file("recording.mcap");
    options.limits.disk_margin_bytes = 0;
    return options;
  }

  // Records `count` messages of 1000 samples, which take 16 kB each.
  RecorderSummary record(const RecorderOptions& options, int count, int trigger_after = -1) {
    const int domain = domain_of_this_test();
    Participant sender(loopback_participant("sender", domain));
    Writer<msg::Axis> axis(sender, kAxisTopic);
    Participant receiver(loopback_participant("receiver", domain));
    Recorder recorder(receiver, topics_named({"axis"}, "test_rig"), options);
    sender.start();
    receiver.start();
    for (int i = 0; i < count; ++i) {
      msg::Axis message;
      message.samples().resize(1000);
      axis.write(message);
      if (i == trigger_after) {
        EXPECT_TRUE(came(recorder, i + 1));
        recorder.trigger();
      }
    }
    EXPECT_TRUE(came(recorder, count));
    receiver.stop();
    return recorder.finish();
  }

  static bool came(const Recorder& recorder, int count) {
    return wait_until(
        [&] { return recorder.summary().total().messages == static_cast<std::uint64_t>(count); });
  }

  static std::vector<std::uint64_t> numbers_in(const std::vector<std::string>& files) {
    std::vector<std::uint64_t> numbers;
    for (const std::string& file : files) {
      auto reader = McapReader::open(file);
      if (!reader) continue;
      while (const auto message = reader->next()) {
        numbers.push_back(decode_cdr<msg::Axis>(message->data)->sequence_number());
      }
      EXPECT_TRUE(reader->damage().none());
    }
    return numbers;
  }

  ScratchFolder scratch_;
};

TEST_F(RecorderTest, SplitsBySizeAndLosesNothing) {
  RecorderOptions split = options();
  split.limits.split_bytes = 1 << 17;
  const RecorderSummary summary = record(split, 20);
  EXPECT_EQ(summary.files.size(), 3U);
  EXPECT_EQ(summary.files.back(), scratch_.file("recording_2.mcap"));
  const auto numbers = numbers_in(summary.files);
  ASSERT_EQ(numbers.size(), 20U);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i + 1);
  EXPECT_EQ(summary.total().lost + summary.total().dropped, 0U);
}

TEST_F(RecorderTest, WhatTheQueueCannotHoldIsCounted) {
  RecorderOptions narrow = options();
  narrow.queue_bytes = 1000;
  const RecorderSummary summary = record(narrow, 5);
  EXPECT_EQ(summary.total().messages, 5U);
  EXPECT_EQ(summary.total().dropped, 5U);
  EXPECT_TRUE(numbers_in(summary.files).empty());
}

TEST_F(RecorderTest, KeepsTheLastAndWritesThemWhenTriggered) {
  RecorderOptions last = options();
  last.last = std::chrono::seconds(60);
  last.last_bytes = 5 * 16500;
  EXPECT_TRUE(record(last, 8).files.empty()) << "no trigger came";
  const RecorderSummary summary = record(last, 12, 11);
  EXPECT_EQ(numbers_in(summary.files), (std::vector<std::uint64_t>{8, 9, 10, 11, 12}));
}

// A disk of a quarter of a megabyte, where one may be mounted.
class SmallDisk {
 public:
  explicit SmallDisk(std::string path) : path_(std::move(path)) {
    std::filesystem::create_directory(path_);
    mounted_ = mount("swivel_test", path_.c_str(), "tmpfs", 0, "size=256k") == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount(path_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }

 private:
  std::string path_;
  bool mounted_ = false;
};

TEST_F(RecorderTest, ADiskThatFillsUpIsToldAndWhatItDoesNotHoldIsCounted) {
  const SmallDisk disk(scratch_.file("disk"));
  if (!disk.mounted()) GTEST_SKIP() << "no disk can be mounted here; it takes root";
  RecorderOptions small = options();
  small.path = scratch_.file("disk/recording.mcap");
  small.limits.split_bytes = 100'000;  // several files fit, and then half of one
  const RecorderSummary summary = record(small, 40);
  EXPECT_THAT(summary.failure, HasSubstr("No space left on device"));
  std::uint64_t held = 0;
  for (const std::string& file : summary.files) {
    for (const std::string& name : {file, file + ".part"}) {
      auto reader = McapReader::open(name);
      while (reader && reader->next()) ++held;
    }
  }
  EXPECT_GT(held, 5U);
  EXPECT_EQ(summary.total().messages, 40U);
  EXPECT_EQ(summary.total().dropped, 40U - held);
}

TEST_F(RecorderTest, AFullDiskEndsItBeforeItBegins) {
  RecorderOptions full = options();
  full.limits.disk_margin_bytes = std::uint64_t{1} << 60;
  Participant participant(loopback_participant("receiver", domain_of_this_test()));
  try {
    const Recorder recorder(participant, all_topics(), full);
    FAIL() << "began";
  } catch (const ExitError& error) {
    EXPECT_EQ(error.code, kExitCannotWrite);
    EXPECT_THAT(error.what(), HasSubstr("MB are free"));
  }
}

}  // namespace
}  // namespace swivel
