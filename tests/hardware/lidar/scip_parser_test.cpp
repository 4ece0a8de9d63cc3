#include "hardware/lidar/scip_parser.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hardware/lidar/scip_replies.hpp"
#include "tests/hardware/lidar/scip_samples.hpp"

namespace swivel::scip {
namespace {

bool is_equal(const Reply& left, const Reply& right) {
  return left.echo == right.echo && left.status == right.status && left.texts == right.texts &&
         left.text_ends == right.text_ends;
}

// What a session says, in one string.
std::string conversation() {
  std::string texts;
  append_text(texts, encode_value(42, 4));
  std::string said = reply_of("QT", "00");
  for (const std::string& next :
       {parameters_reply(), reply_of("TM1", "00", texts), reply_of("ME0000108001000", "00"),
        scan_of(1081, true, 1), scan_of(1081, true, 2)})
    said += next;
  return said;
}

TEST(ScipParser, AnyCuttingOfTheBytesGivesTheSameReplies) {
  const std::string bytes = conversation();
  const std::vector<Reply> expected = Parser().push(bytes);
  ASSERT_EQ(expected.size(), 6U);
  std::mt19937 random(7);
  for (const std::size_t longest : {1U, 2U, 7U, 64U, 1000U, 5000U}) {
    Parser parser;
    std::vector<Reply> replies;
    for (std::size_t start = 0; start < bytes.size();) {
      const std::size_t count = 1 + random() % longest;
      for (Reply& reply : parser.push(std::string_view(bytes).substr(start, count)))
        replies.push_back(std::move(reply));
      start += count;
    }
    ASSERT_EQ(replies.size(), expected.size()) << longest;
    for (std::size_t which = 0; which < replies.size(); ++which)
      EXPECT_TRUE(is_equal(replies[which], expected[which])) << longest;
    EXPECT_EQ(parser.counters().resyncs, 0U);
  }
}

// A change of one bit is seen by the sum, or falls on the frame and drops the reply. Where it hits
// a line end, the sum of the two lines in one is right by chance once in 64: the values are then
// too few. The echo has no sum, and is the session's to check.
TEST(ScipParser, OneChangedBitNeverGivesAWrongScan) {
  const std::string good = scan_of(60, true);
  const auto decode = [](const Reply& reply) {
    return decode_scan(reply, Measurement::kRangesAndIntensities, 60);
  };
  const auto truth = decode(parsed(good));
  for (std::size_t place = 0; place < 8 * good.size(); ++place) {
    std::string damaged = good;
    damaged[place / 8] = static_cast<char>(damaged[place / 8] ^ 1 << place % 8);
    Parser parser;
    std::size_t scans = 0;
    damaged.append(good).append(good);
    for (const Reply& reply : parser.push(damaged)) {
      const auto scan = decode(reply);
      if (!scan) continue;
      ++scans;
      ASSERT_EQ(scan->ranges_mm, truth->ranges_mm) << place;
      ASSERT_EQ(scan->stamp_ms, truth->stamp_ms) << place;
    }
    ASSERT_GE(scans, 1U) << place;
  }
}

TEST(ScipParser, AWrongSumCostsOneReplyAndIsCounted) {
  std::string damaged = scan_of(1081, true, 1);
  damaged[200] = damaged[200] == '0' ? '1' : '0';
  Parser parser;
  const std::vector<Reply> replies =
      parser.push(scan_of(1081, true) + damaged + scan_of(1081, true, 2));
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(decode_scan(replies[1], Measurement::kRangesAndIntensities, 1081)->stamp_ms, 0x123458U);
  EXPECT_EQ(parser.counters().bad_sums, 1U);
  EXPECT_EQ(parser.counters().resyncs, 1U);
}

TEST(ScipParser, GarbageGivesNoScanAndTheNextReplyIsWhole) {
  std::mt19937 random(11);
  for (int round = 0; round < 300; ++round) {
    std::string garbage(random() % 5000, '\0');
    for (char& byte : garbage)
      byte = static_cast<char>(round % 2 == 0 ? random() : "\n0QPM9b"[random() % 7]);
    Parser parser;
    for (const Reply& reply : parser.push(garbage + "\n\n"))
      EXPECT_FALSE(decode_scan(reply, Measurement::kRanges, 1081));
    const std::vector<Reply> replies = parser.push(conversation());
    EXPECT_EQ(replies.size(), 6U) << round;
  }
}

TEST(ScipParser, EndlessLinesAndEndlessRepliesAreCutShort) {
  Parser parser;
  const std::string line(1'000'000, 'x');
  for (int time = 0; time < 50; ++time) EXPECT_TRUE(parser.push(line).empty());
  EXPECT_EQ(parser.push("\n\n" + conversation()).size(), 6U);
  std::string reply = "ME\n99b\n";
  for (int text = 0; text < 100'000; ++text) append_text(reply, std::string(64, '0'));
  EXPECT_TRUE(parser.push(reply + "\n").empty());
  EXPECT_EQ(parser.counters().resyncs, 2U);
  EXPECT_EQ(parser.push(conversation()).size(), 6U);
}

}  // namespace
}  // namespace swivel::scip
