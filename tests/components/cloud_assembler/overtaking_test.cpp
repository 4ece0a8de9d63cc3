// Lines, angles and phases travel on topics of their own and overtake each other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/components/cloud_assembler/story.hpp"

namespace swivel {
namespace {

// Takes from the topics by chance, each in its own order.
std::vector<Event> shuffled(std::vector<TopicEvents> topics, std::mt19937& random) {
  std::vector<Event> events;
  while (!topics.empty()) {
    const std::size_t chosen = random() % topics.size();
    events.push_back(topics[chosen].front());
    topics[chosen].erase(topics[chosen].begin());
    if (topics[chosen].empty()) topics.erase(topics.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return events;
}

TopicEvents lines_of(const Story& story, int first, int end, std::optional<int> lost) {
  TopicEvents lines;
  for (int index = first; index < end; ++index) {
    if (index != lost) lines.emplace_back(story.line(index));
  }
  return lines;
}

// A sweep whose axis comes in pieces.
TopicEvents axis_of(const Story& story) {
  TopicEvents topic;
  for (const double part : {0.0, 0.3, 0.55, 1.0}) {
    const double length_ns = static_cast<double>(story.window_end_ns() - story.window_start_ns());
    msg::AxisSample sample;
    sample.time_ns(story.window_start_ns() + std::llround(part * length_ns));
    sample.angle_deg(deg_from_rad(story.axis_angle_rad(sample.time_ns())));
    msg::Axis axis;
    axis.sequence_number(topic.size() + 1);
    axis.samples({sample});
    topic.emplace_back(axis);
  }
  return topic;
}

TEST(Overtaking, AnyInterleavingOfTheTopicsGivesTheSameCloud) {
  const Story story;
  std::mt19937 random(7);
  for (int round = 0; round < 150; ++round) {
    const std::optional<int> lost = round % 2 == 0 ? std::nullopt : std::optional(1 + round % 10);
    const std::vector<TopicEvents> topics{
        lines_of(story, -5, 16, lost),
        axis_of(story),
        {story.phase(msg::PHASE_ACCELERATING), story.cruising(),
         story.phase(msg::PHASE_DECELERATING), story.phase(msg::PHASE_RETURNING)}};
    Stage stage;
    for (const Event& event : shuffled(topics, random)) stage.add(event);
    ASSERT_EQ(stage.sweeps.size(), 1U) << "round " << round;
    EXPECT_EQ(stage.sweeps[0].sweep.complete(), !lost);
    expect_same(stage.sweeps[0].cloud,
                expected_cloud(story, lost ? std::vector<int>{*lost} : std::vector<int>{}));
    stage.expect_counters_add_up();
  }
}

TopicEvents windows_of(const Story& story) {
  TopicEvents topic;
  for (std::uint32_t index = 0; index < story.lines; ++index) {
    msg::Sweep window = story.cruising();
    window.window_start_ns(story.line_time_ns(static_cast<int>(index)) - 10 * kMillisecondNs);
    window.window_end_ns(story.line_time_ns(static_cast<int>(index)) + 40 * kMillisecondNs);
    window.window_first_line(index);
    window.window_lines(1);
    topic.emplace_back(window);
  }
  topic.emplace_back(story.phase(msg::PHASE_DECELERATING));
  return topic;
}

TEST(Overtaking, StopAndGoGivesTheSameCloudToo) {
  Story story;
  story.true_period_ns = 300 * kMillisecondNs;
  std::mt19937 random(11);
  for (int round = 0; round < 150; ++round) {
    const int lost = 1 + round % 10;
    Stage stage;
    for (const Event& event :
         shuffled({lines_of(story, -2, 14, lost), axis_of(story), windows_of(story)}, random)) {
      stage.add(event);
    }
    ASSERT_EQ(stage.sweeps.size(), 1U) << "round " << round;
    EXPECT_EQ(stage.sweeps[0].sweep.lines_missing(), 1U);
    expect_same(stage.sweeps[0].cloud, expected_cloud(story, {lost}));
    stage.expect_counters_add_up();
  }
}

// A cancel in the middle of the sweep: whatever came first, the last word is that it is not whole.
TEST(Overtaking, ACancelledSweepIsNeverTheLastWordWhole) {
  const Story story;
  msg::Sweep cancel = story.phase(msg::PHASE_DECELERATING, "cancelled");
  cancel.time_ns(story.line_time_ns(8));
  std::mt19937 random(13);
  for (int round = 0; round < 150; ++round) {
    const std::vector<TopicEvents> topics{
        lines_of(story, -5, 16, {}),
        axis_of(story),
        {story.cruising(), cancel, story.phase(msg::PHASE_IDLE, "cancelled")}};
    Stage stage;
    for (const Event& event : shuffled(topics, random)) stage.add(event);
    ASSERT_FALSE(stage.sweeps.empty()) << "round " << round;
    EXPECT_FALSE(stage.sweeps.back().sweep.complete()) << "round " << round;
    EXPECT_EQ(stage.sweeps.back().sweep.lines_used(), 0U);
    stage.expect_counters_add_up();
  }
}

}  // namespace
}  // namespace swivel
