#include "hardware/lidar/scip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hardware/lidar/scip_replies.hpp"
#include "tests/hardware/lidar/scip_samples.hpp"

namespace swivel::scip {
namespace {

using testing::HasSubstr;

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
  append_data(texts, std::string(std::size_t{3} * 1081, '!'));
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

}  // namespace
}  // namespace swivel::scip
