#include "components/gateway/live_view.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <variant>

#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

// What a page makes of the frames: as page.js does.
struct Viewer {
  std::uint32_t number = 0;
  std::string points;

  void take(const Frame& frame) {
    FrameHead head;
    std::memcpy(&head, frame.body->data(), sizeof head);
    if (head.number < number) return;
    if (head.number > number) points.assign(std::size_t{8} * head.lines * head.beams, '\0');
    number = head.number;
    points.replace(std::size_t{8} * head.first_line * head.beams, 8 * head.points(),
                   frame.body->substr(sizeof head));
  }
};

struct ViewOfAStory {
  Story story;
  Viewer early;
  LiveView view{rig(), [this](const Frame& frame) { early.take(frame); }};

  static RigFile rig() {
    RigFile rig;
    rig.rig = "swivel";
    rig.geometry = story_geometry();
    return rig;
  }
  void take(const Event& event) {
    std::visit([this](const auto& message) { view.take(message); }, event);
  }
  void scan(int lines) {
    take(story.axis());
    take(story.cruising());
    for (int index = -2; index < lines; ++index) take(story.line(index));
  }
  Viewer late() const {
    Viewer viewer;
    if (const auto picture = view.whole_picture()) viewer.take(*picture);
    return viewer;
  }
  std::string cloud(const std::string& frame) {
    PointCloud2Message message;
    to_message(expected_cloud(story), story.first_beam_ns, frame, message);
    return view.take(message);
  }
  msg::Attitude attitude(msg::Verdict verdict = msg::VERDICT_GOOD) const {
    msg::Attitude attitude;
    attitude.first_beam_time_ns(story.first_beam_ns);
    attitude.sweep_id(story.sweep_id);
    attitude.mode(3);
    attitude.verdict(verdict);
    attitude.lines_expected(story.lines);
    return attitude;
  }
  Trust::Level level() const { return trust_in(view.picture()).level; }
};

std::string packed_points(const OrganisedCloud& cloud) {
  FrameHead head{FrameKind::kCloud,
                 0,
                 0,
                 static_cast<std::uint32_t>(cloud.beams),
                 0,
                 static_cast<std::uint32_t>(cloud.lines)};
  return packed_frame(head, cloud.points.data()).substr(sizeof head);
}

TEST(LiveView, ShowsTheRunningSweepLineByLineAsItWillBeAssembled) {
  ViewOfAStory test;
  test.scan(5);
  EXPECT_EQ(test.view.picture().kind, Picture::Kind::kRunning);
  EXPECT_EQ(test.view.picture().lines_in, 5U);
  const std::string all = packed_points(expected_cloud(test.story));
  const std::size_t so_far = 5 * test.story.beams * 8;
  EXPECT_EQ(test.early.points.substr(0, so_far), all.substr(0, so_far));
  EXPECT_EQ(test.early.points.substr(so_far), std::string(all.size() - so_far, '\0'));
}

TEST(LiveView, ALateClientSeesWhatAnEarlyOneSees) {
  for (const int lines : {1, 4, 11, 12}) {
    ViewOfAStory test;
    test.scan(lines);
    EXPECT_EQ(test.late().points, test.early.points) << lines;
  }
  ViewOfAStory test;
  EXPECT_FALSE(test.view.whole_picture());
  test.scan(13);
  ASSERT_EQ(test.cloud("swivel/base"), "");
  EXPECT_EQ(test.late().points, test.early.points);
  EXPECT_EQ(test.late().points, packed_points(expected_cloud(test.story)));
}

TEST(LiveView, GoodIsOnlyACloudInTheBaseWithAGoodAttitudeOfItsOwn) {
  ViewOfAStory test;
  EXPECT_EQ(test.level(), Trust::Level::kNothing);
  test.scan(5);
  EXPECT_EQ(test.level(), Trust::Level::kRunning);
  test.view.take(test.attitude());
  EXPECT_EQ(test.level(), Trust::Level::kRunning);
  test.cloud("swivel/base");
  EXPECT_EQ(test.level(), Trust::Level::kGood);
  test.cloud("swivel/start");
  EXPECT_EQ(test.level(), Trust::Level::kBad);
  test.cloud("swivel/base");
  EXPECT_EQ(test.level(), Trust::Level::kGood);

  for (const msg::Verdict verdict :
       {msg::VERDICT_NO_PLATE, msg::VERDICT_TOO_FEW_POINTS, msg::VERDICT_FOREIGN_OBJECT,
        msg::VERDICT_LINES_MISSING, msg::VERDICT_SEAM_OPEN}) {
    test.view.take(test.attitude(verdict));
    EXPECT_EQ(test.level(), Trust::Level::kBad) << verdict;
  }
  test.view.take(test.attitude(msg::VERDICT_MEASURED));
  EXPECT_EQ(test.level(), Trust::Level::kGood);

  msg::Attitude incomplete = test.attitude();
  incomplete.lines_missing(1);
  test.view.take(incomplete);
  EXPECT_EQ(test.level(), Trust::Level::kBad);
}

TEST(LiveView, WithoutACalibrationTheHeadlineSaysSo) {
  ViewOfAStory test;
  test.cloud("swivel/base");
  msg::Attitude attitude = test.attitude();
  test.view.take(attitude);
  EXPECT_EQ(trust_in(test.view.picture()).headline, "Not calibrated");
  attitude.calibrated(true);
  test.view.take(attitude);
  EXPECT_EQ(trust_in(test.view.picture()).headline, "Good");
}

TEST(LiveView, AnotherSweepsAttitudeSaysNothing) {
  ViewOfAStory test;
  msg::Attitude other = test.attitude();
  other.first_beam_time_ns(other.first_beam_time_ns() + 1);
  test.view.take(other);
  test.cloud("swivel/base");
  EXPECT_EQ(test.level(), Trust::Level::kWaiting);
  test.view.take(test.attitude());
  EXPECT_EQ(test.level(), Trust::Level::kGood);
  test.view.take(other);  // of the next sweep
  EXPECT_EQ(test.level(), Trust::Level::kGood);
}

TEST(LiveView, WhatIsTakenBackIsNotGood) {
  for (const bool before : {false, true}) {
    ViewOfAStory test;
    test.view.take(test.attitude());
    msg::Sweep taken_back = test.story.phase(msg::PHASE_ASSEMBLED, "motor fault, do not use");
    taken_back.first_beam_time_ns(test.story.first_beam_ns);
    if (before) test.view.take(taken_back);
    test.cloud("swivel/base");
    if (!before) test.view.take(taken_back);
    EXPECT_EQ(test.level(), Trust::Level::kBad);
    EXPECT_EQ(trust_in(test.view.picture()).reason, "motor fault, do not use");
  }
}

TEST(LiveView, ACancelledSweepIsStoppedNotGood) {
  ViewOfAStory test;
  test.scan(5);
  test.take(test.story.phase(msg::PHASE_DECELERATING, "cancelled"));
  EXPECT_EQ(test.view.picture().kind, Picture::Kind::kStopped);
  EXPECT_EQ(test.level(), Trust::Level::kBad);
  EXPECT_THAT(trust_in(test.view.picture()).reason, testing::HasSubstr("cancelled"));
}

TEST(LiveView, TheNextSweepBeginsAPictureOfItsOwn) {
  ViewOfAStory test;
  test.scan(13);
  test.cloud("swivel/base");
  test.view.take(test.attitude());
  test.story.sweep_id = 8;
  test.story.first_beam_ns += 5'000'000'000;
  test.scan(1);
  EXPECT_EQ(test.level(), Trust::Level::kRunning);
  EXPECT_EQ(test.early.points, test.late().points);
  EXPECT_EQ(test.view.picture().lines_in, 1U);
  test.story.first_beam_ns -= 5'000'000'000;
  test.cloud("swivel/base");  // of the sweep before: too late to be shown
  EXPECT_EQ(test.level(), Trust::Level::kRunning);
}

TEST(LiveView, AMalformedCloudIsRefusedAndChangesNothing) {
  ViewOfAStory test;
  test.scan(5);
  PointCloud2Message message;
  to_message(expected_cloud(test.story), test.story.first_beam_ns, "swivel/base", message);
  message.height(message.height() + 1);
  EXPECT_NE(test.view.take(message), "");
  EXPECT_EQ(test.level(), Trust::Level::kRunning);
}

}  // namespace
}  // namespace swivel
