#include "hardware/lidar/scip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "hardware/lidar/scip_parser.hpp"
#include "hardware/lidar/scip_replies.hpp"

namespace swivel::scip {
namespace {

using testing::HasSubstr;

std::string reply_of(const std::string& echo, const std::string& status,
                     const std::string& texts = {}) {
  std::string reply = echo + "\n";
  append_text(reply, status);
  return reply + texts + "\n";
}

// A scan of `beams` whose beam k measures 20 k + `shift` mm, of intensity 1000 + k.
std::string scan_of(int beams, bool has_intensities, std::uint32_t shift = 0) {
  std::string texts;
  append_text(texts, encode_value(0x123456 + shift, 4));
  std::string data;
  for (std::uint32_t beam = 0; beam < static_cast<std::uint32_t>(beams); ++beam) {
    append_value(data, 20 * beam + shift, 3);
    if (has_intensities) append_value(data, 1000 + beam, 3);
  }
  append_data(texts, data);
  return reply_of(has_intensities ? "ME0000108001000" : "MD0000108001000", "99", texts);
}

std::string parameters_reply(const std::string& last_key = {}, const std::string& last_value = {}) {
  std::string texts;
  append_key(texts, "MODL", "UST-10LX");
  append_key(texts, "DMIN", "20");
  append_key(texts, "DMAX", "30000");
  append_key(texts, "ARES", "1440");
  append_key(texts, "AMIN", "0");
  append_key(texts, "AMAX", "1080");
  append_key(texts, "AFRT", "540");
  append_key(texts, "SCAN", "2400");
  if (!last_key.empty()) append_key(texts, last_key, last_value);
  return reply_of("PP", "00", texts);
}

Reply parsed(const std::string& bytes) {
  Parser parser;
  const std::vector<Reply> replies = parser.push(bytes);
  EXPECT_EQ(replies.size(), 1U);
  return replies.empty() ? Reply{} : replies.front();
}

bool operator_equal(const Reply& left, const Reply& right) {
  return left.echo == right.echo && left.status == right.status && left.texts == right.texts &&
         left.text_ends == right.text_ends;
}

// C-42-04076, page 5, and sums that drivers print.
TEST(Scip, TheSpecificationsOwnNumbers) {
  EXPECT_EQ(decode_value("1Dh"), 5432U);
  EXPECT_EQ(encode_value(5432, 3), "1Dh");
  EXPECT_EQ(checksum("00"), 'P');
  EXPECT_EQ(checksum("01"), 'Q');
  EXPECT_EQ(checksum("02"), 'R');
  EXPECT_EQ(checksum("10"), 'Q');
  EXPECT_EQ(checksum("99"), 'b');
  EXPECT_EQ(checksum("0C"), 'c');
  EXPECT_EQ(checksum("0E"), 'e');
  EXPECT_EQ(checksum("0F"), 'f');
}

TEST(Scip, ValuesComeBackFromTheirCharacters) {
  for (const int characters : {2, 3, 4})
    for (std::uint32_t value = 0; value >> (6 * characters) == 0; value += value / 97 + 1)
      ASSERT_EQ(decode_value(encode_value(value, characters)), value);
  EXPECT_EQ(encode_value(0xFFFFFF, 4), "oooo");
  EXPECT_FALSE(decode_value("0/0"));
  EXPECT_FALSE(decode_value("0p0"));
  EXPECT_FALSE(decode_value("0\xFF"));
}

// A program on a real UST-10LX counts 103 + 3 * 1081 bytes after the stamp's line, and ME has
// 101 texts of 64 characters and one of 22.
TEST(Scip, ScansAreAsLongAsOnTheWire) {
  const auto after_stamp = [](const std::string& scan) {
    return scan.size() - std::string("MD0000108001000\n99b\n????s\n").size();
  };
  EXPECT_EQ(after_stamp(scan_of(1081, false)), 103U + 3 * 1081);
  EXPECT_EQ(after_stamp(scan_of(1081, true)), 6U * 1081 + 2 * 102 + 1);
  const Reply reply = parsed(scan_of(1081, true));
  ASSERT_EQ(reply.text_count(), 103U);
  EXPECT_EQ(reply.text(1).size(), 64U);
  EXPECT_EQ(reply.text(102).size(), 22U);
}

TEST(Scip, RequestsAreAsTheVendorWritesThem) {
  EXPECT_EQ(scan_request(Measurement::kRanges, 0, 1080), "MD0000108001000");
  EXPECT_EQ(scan_request(Measurement::kRangesAndIntensities, 44, 725, 5), "ME0044072501005");
}

TEST(Scip, ScansComeBackWhole) {
  for (const bool has_intensities : {false, true}) {
    const auto measurement =
        has_intensities ? Measurement::kRangesAndIntensities : Measurement::kRanges;
    const auto scan = decode_scan(parsed(scan_of(1081, has_intensities)), measurement, 1081);
    ASSERT_TRUE(scan) << scan.reason();
    EXPECT_EQ(scan->stamp_ms, 0x123456U);
    ASSERT_EQ(scan->ranges_mm.size(), 1081U);
    for (std::size_t beam = 0; beam < 1081; ++beam) {
      ASSERT_EQ(scan->ranges_mm[beam], 20 * beam);
      if (has_intensities) {
        ASSERT_EQ(scan->intensities[beam], 1000 + beam);
      }
    }
    EXPECT_EQ(scan->intensities.size(), has_intensities ? 1081U : 0U);
    EXPECT_EQ(scan->saturated, 0U);
  }
}

TEST(Scip, ValuesBeyond16BitsSaturateAndAreCounted) {
  std::string texts;
  append_text(texts, encode_value(1, 4));
  append_data(texts, encode_value(65535, 3) + encode_value(65536, 3) + encode_value(262143, 3));
  const auto scan = decode_scan(parsed(reply_of("MD", "99", texts)), Measurement::kRanges, 3);
  ASSERT_TRUE(scan) << scan.reason();
  EXPECT_THAT(scan->ranges_mm, testing::Each(65535));
  EXPECT_EQ(scan->saturated, 2U);
}

TEST(Scip, ScansThatAreNotAsAskedForAreRefusedInWords) {
  const auto reason = [](const std::string& bytes, Measurement measurement) {
    return decode_scan(parsed(bytes), measurement, 1081).reason();
  };
  EXPECT_THAT(reason(scan_of(1080, false), Measurement::kRanges), HasSubstr("1080 points"));
  EXPECT_THAT(reason(scan_of(1082, true), Measurement::kRangesAndIntensities),
              HasSubstr("1082 points"));
  EXPECT_FALSE(reason(scan_of(1081, true), Measurement::kRanges).empty());
  std::string texts;
  append_text(texts, "123");
  EXPECT_THAT(reason(reply_of("MD", "99", texts), Measurement::kRanges),
              HasSubstr("3 characters instead of 4"));
  EXPECT_THAT(reason(reply_of("MD", "99"), Measurement::kRanges), HasSubstr("missing"));
  texts.clear();
  append_text(texts, "0000");
  append_data(texts, std::string(3 * 1081, '!'));
  EXPECT_THAT(reason(reply_of("MD", "99", texts), Measurement::kRanges), HasSubstr("not allowed"));
}

TEST(Scip, IdentityNeedsProductFirmwareAndSerialNumber) {
  std::string texts;
  append_key(texts, "PROD", "UST-10LX");
  append_key(texts, "FIRM", "4.0.2-A");
  append_key(texts, "XXXX", "an unknown key");
  const std::string without_serial = reply_of("VV", "00", texts);
  append_key(texts, "SERI", "H1642740");
  const auto identity = decode_identity(parsed(reply_of("VV", "00", texts)));
  ASSERT_TRUE(identity) << identity.reason();
  EXPECT_EQ(identity->product, "UST-10LX");
  EXPECT_EQ(identity->firmware, "4.0.2-A");
  EXPECT_EQ(identity->serial_number, "H1642740");
  EXPECT_EQ(identity->vendor, "");
  EXPECT_THAT(decode_identity(parsed(without_serial)).reason(), HasSubstr("SERI is missing"));
}

TEST(Scip, ParametersGiveTheAnglesOfTheBeams) {
  const auto read = decode_parameters(parsed(parameters_reply()));
  ASSERT_TRUE(read) << read.reason();
  EXPECT_EQ(read->beams(), 1081);
  EXPECT_EQ(read->range_min_mm, 20);
  EXPECT_EQ(read->range_max_mm, 30000);
  EXPECT_DOUBLE_EQ(read->first_beam_angle_deg(), -135.0);
  EXPECT_DOUBLE_EQ(read->beam_step_deg(), 0.25);
  EXPECT_DOUBLE_EQ(read->scan_period_ns(), 25e6);
}

TEST(Scip, AClockwiseSensorHasItsAnglesFlipped) {
  const auto read = decode_parameters(parsed(parameters_reply("SDIR", "CW")));
  ASSERT_TRUE(read) << read.reason();
  EXPECT_DOUBLE_EQ(read->first_beam_angle_deg(), 135.0);
  EXPECT_DOUBLE_EQ(read->beam_step_deg(), -0.25);
  const auto other = decode_parameters(parsed(parameters_reply("SDIR", "CCW")));
  EXPECT_DOUBLE_EQ(other->first_beam_angle_deg(), -135.0);
}

TEST(Scip, ParametersThatNoSensorHasAreRefused) {
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, std::string>>{{"ARES", "0"},
                                                        {"ARES", "1000"},
                                                        {"SCAN", "0"},
                                                        {"SCAN", "fast"},
                                                        {"AMAX", "99999"},
                                                        {"AMIN", "-1"},
                                                        {"AMIN", "1081"},
                                                        {"DMAX", "20"},
                                                        {"DMIN", ""}})
    EXPECT_FALSE(decode_parameters(parsed(parameters_reply(key, value)))) << key << value;
  EXPECT_THAT(decode_parameters(parsed(reply_of("PP", "00"))).reason(), HasSubstr("is missing"));
}

TEST(Scip, StateTellsTheTimeInBothWritings) {
  const auto stamp = [](const std::string& time) {
    std::string texts;
    append_key(texts, "TIME", time);
    append_key(texts, "STAT", "sensor is working normally");
    return decode_state(parsed(reply_of("II", "00", texts)))->stamp_ms;
  };
  EXPECT_EQ(stamp(encode_value(0xABCDEF, 4)), 0xABCDEFU);
  EXPECT_EQ(stamp("ABCDEF"), 0xABCDEFU);
  EXPECT_EQ(stamp("00001"), std::nullopt);
  EXPECT_EQ(stamp("ABCDEG"), std::nullopt);
}

TEST(Scip, KeyLinesMayCountTheirSemicolon) {
  std::string texts;
  append_text(texts, "STAT:fine;");  // the sum over all of it
  EXPECT_EQ(decode_state(parsed(reply_of("II", "00", texts)))->status, "fine");
}

TEST(Scip, ClockAnswersAreOneStamp) {
  std::string texts;
  append_text(texts, encode_value(1234567, 4));
  EXPECT_EQ(*decode_clock(parsed(reply_of("TM1", "00", texts))), 1234567U);
  append_text(texts, "more");
  EXPECT_FALSE(decode_clock(parsed(reply_of("TM1", "00", texts))));
  EXPECT_FALSE(decode_clock(parsed(reply_of("TM1", "00"))));
}

TEST(Scip, StatusesAreWords) {
  EXPECT_EQ(status_in_words("ME0000108001000", "04"), "status 04: the last step is out of range");
  EXPECT_EQ(status_in_words("TM2", "03"), "status 03: already out of clock mode");
  EXPECT_THAT(status_in_words("MD", "33"), HasSubstr("verifies"));
  EXPECT_THAT(status_in_words("MD", "97"), HasSubstr("hardware"));
  EXPECT_THAT(status_in_words("VV", "33"), HasSubstr("unknown"));
  EXPECT_THAT(status_in_words("ME", "0M"), HasSubstr("unstable"));
  // Sources disagree: both readings.
  EXPECT_THAT(status_in_words("XX", "0F"), HasSubstr("not supported, or insufficient"));
  EXPECT_THAT(status_in_words("", ""), HasSubstr("unknown"));
}

TEST(Scip, BeamsKnowWhetherTheyMeasured) {
  const auto status = [](std::uint16_t range_mm) { return beam_status(range_mm, 20, 30000); };
  EXPECT_EQ(status(4), BeamStatus::kTooNear);
  EXPECT_EQ(status(65533), BeamStatus::kNoReturn);
  EXPECT_EQ(status(0), BeamStatus::kNoReturn);
  EXPECT_EQ(status(19), BeamStatus::kOutOfRange);
  EXPECT_EQ(status(20), BeamStatus::kValid);
  EXPECT_EQ(status(30000), BeamStatus::kValid);
  EXPECT_EQ(status(30001), BeamStatus::kOutOfRange);
  EXPECT_EQ(status(65535), BeamStatus::kOutOfRange);
  EXPECT_EQ(beam_status(4, 0, 65532), BeamStatus::kTooNear);
}

// What a session says, in one string.
std::string conversation() {
  std::string texts;
  append_text(texts, encode_value(42, 4));
  return reply_of("QT", "00") + parameters_reply() + reply_of("TM1", "00", texts) +
         reply_of("ME0000108001000", "00") + scan_of(1081, true, 1) + scan_of(1081, true, 2);
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
      EXPECT_TRUE(operator_equal(replies[which], expected[which])) << longest;
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
    for (const Reply& reply : parser.push(damaged + good + good)) {
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
