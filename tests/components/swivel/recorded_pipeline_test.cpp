// What is recorded of the stages, and played to them again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "components/common/roll.hpp"
#include "components/mcap/reader.hpp"
#include "components/swivel/live/child_process.hpp"
#include "run_swivel.hpp"
#include "scratch_folder.hpp"
#include "tests/components/dds/test_participant.hpp"
#include "witness.hpp"

namespace swivel {
namespace {

// The stages with a recorder beside them, from the start of one to the end of both.
class RecordedStages {
 public:
  RecordedStages(const ScratchFolder& scratch, const std::string& file)
      : domain_(domain_of_this_test()), scratch_(scratch), recording_(scratch.file(file)) {}

  // Plays a recording to the stages; the new recording's path.
  std::string play(const std::string& recording, double sweeps) {
    const std::string domain = std::to_string(domain_);
    ParticipantOptions options = loopback_participant("stages_test", domain_);
    options.rig = "swivel";
    Participant participant(options);
    Witness witness(participant);
    const Roll roll(participant);
    // Nobody but the recorder listens to requests.
    Writer<msg::SweepRequest> requests(participant, kSweepRequestTopic);
    participant.start();
    ChildProcess recorder("swivel", {"record", "-o", recording_, "--domain", domain});
    EXPECT_TRUE(wait_until([&] { return requests.reader_count() > 0; }));
    ChildProcess up("swivel", {"up", "--role", "workstation", "--domain", domain, "--log-level",
                               "warning", "--calibration", scratch_.file("none.yaml")});
    EXPECT_TRUE(wait_until([&] { return roll.entries().size() >= 3; }));
    EXPECT_EQ(run_swivel(scratch_, "replay --max " + recording + " --domain " + domain), 0)
        << content_of(scratch_.file("err"));
    EXPECT_TRUE(wait_until([&] { return witness.messages("rt/swivel/cloud") == sweeps; }));
    recorder.ask_to_stop();
    EXPECT_TRUE(recorder.wait_or_kill(std::chrono::seconds(20)));
    EXPECT_EQ(recorder.exit_code(), 0);
    participant.stop();
    return recording_;
  }

 private:
  int domain_;
  const ScratchFolder& scratch_;
  std::string recording_;
};

// The messages of a topic, byte for byte.
std::vector<std::string> recorded(const std::string& path, const std::string& topic) {
  std::vector<std::string> messages;
  auto reader = McapReader::open(path);
  if (!reader) return messages;
  while (const auto message = reader->next()) {
    if (reader->channel(message->channel_id).topic == topic) messages.emplace_back(message->data);
  }
  EXPECT_TRUE(reader->damage().none());
  return messages;
}

// What process makes of a recording, as text.
std::string attitudes_of(const ScratchFolder& scratch, const std::string& recording) {
  EXPECT_EQ(run_swivel(scratch, "process --no-clouds --no-pictures " + recording + " -o " +
                                    scratch.file("processed")),
            0)
      << content_of(scratch.file("err"));
  return content_of(scratch.file("processed/attitude.csv"));
}

TEST(RecordedPipeline, WhatWasRecordedGivesTheSameCloudsBitForBitWhenItIsReplayed) {
  const ScratchFolder scratch;
  const std::string original = std::string(SWIVEL_TEST_DATA) + "/recordings/plate_period";
  const std::string first = RecordedStages(scratch, "first.mcap").play(original, 2.0);
  const std::string second = RecordedStages(scratch, "second.mcap").play(first, 2.0);
  for (const char* topic : {"swivel/scan_line", "swivel/axis", "swivel/attitude",
                            "rt/swivel/raw_cloud", "rt/swivel/cloud"}) {
    const auto messages = recorded(first, topic);
    EXPECT_GE(messages.size(), 2U) << topic;
    EXPECT_TRUE(messages == recorded(second, topic)) << topic;
  }
  EXPECT_EQ(attitudes_of(scratch, first), attitudes_of(scratch, original));
  // Of two writers, and so in any order: the assembler's are made again, not played.
  EXPECT_EQ(recorded(first, "swivel/sweep").size(), recorded(second, "swivel/sweep").size());
  EXPECT_EQ(run_swivel(scratch, "check " + second), 0) << content_of(scratch.file("out"));
}

}  // namespace
}  // namespace swivel
