#include "components/gateway/outbox.hpp"

#include <gtest/gtest.h>

#include <random>

namespace swivel {
namespace {

TEST(Outbox, IsBoundedAndCountsWhatItDrops) {
  std::mt19937 random(3);
  Outbox outbox(1000);
  std::size_t pushed = 0, popped = 0, dropped = 0;
  std::string last_pushed, last_popped;
  for (int round = 0; round < 5000; ++round) {
    if (random() % 3 != 0) {
      last_pushed = std::string(random() % 600, 'x') + std::to_string(round);
      dropped += outbox.push(binary_frame(last_pushed));
      ++pushed;
    } else if (const auto frame = outbox.pop()) {
      ASSERT_GT(frame->body->substr(frame->body->find_last_of('x') + 1).size(), 0U);
      last_popped = *frame->body;
      ++popped;
    }
    ASSERT_LE(outbox.bytes(), 1000U);
  }
  while (const auto frame = outbox.pop()) {
    last_popped = *frame->body;
    ++popped;
  }
  EXPECT_EQ(pushed, popped + dropped);
  EXPECT_GT(dropped, 0U);
  EXPECT_EQ(last_popped, last_pushed) << "the newest is never dropped";
  EXPECT_EQ(outbox.bytes(), 0U);
}

TEST(Outbox, TakesAFrameLargerThanItself) {
  Outbox outbox(10);
  EXPECT_EQ(outbox.push(binary_frame("small")), 0U);
  EXPECT_EQ(outbox.push(binary_frame(std::string(100, 'x'))), 1U);
  EXPECT_EQ(outbox.pop()->body->size(), 100U);
}

TEST(Outbox, LagsOnceAfterADropWhenAllHasGone) {
  Outbox outbox(10);
  outbox.push(binary_frame("123456"));
  EXPECT_FALSE(outbox.take_lag());
  outbox.push(binary_frame("123456"));
  EXPECT_FALSE(outbox.take_lag()) << "something still waits";
  outbox.pop();
  EXPECT_TRUE(outbox.take_lag());
  EXPECT_FALSE(outbox.take_lag());
}

}  // namespace
}  // namespace swivel
