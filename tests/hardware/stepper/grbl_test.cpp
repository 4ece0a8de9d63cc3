#include "hardware/stepper/grbl.hpp"

#include <gmock/gmock.h>

#include <random>

namespace swivel {
namespace {

using ::testing::HasSubstr;

// As the firmware 1.1h said it, measured.
const char* const kConversation =
    "\r\nGrbl 1.1h ['$' for help]\r\n[MSG:'$H'|'$X' to unlock]\r\n"
    "<Alarm|MPos:0.000,0.000,0.000|FS:0,0|WCO:1.500,0.000,0.000>\r\n"
    "[MSG:Caution: Unlocked]\r\nok\r\n$100=8.900\r\n$22=1\r\nok\r\n"
    "[VER:1.1h.20190830:]\r\n[OPT:V,15,128]\r\nok\r\n"
    "<Jog|MPos:-134.325,0.000,0.000|FS:1440,0|Ov:100,100,100>\r\n"
    "<Hold:1|WPos:3.250,0.000,0.000|F:90|Pn:X>\r\nerror:9\r\nALARM:3\r\n";

std::vector<GrblMessage> parse(const std::string& bytes) {
  GrblParser parser;
  return parser.push(bytes);
}

template <class Kind>
Kind only(const std::string& line) {
  const std::optional<GrblMessage> message = parse_grbl_line(line);
  EXPECT_TRUE(message && std::holds_alternative<Kind>(*message)) << line;
  return message && std::holds_alternative<Kind>(*message) ? std::get<Kind>(*message) : Kind();
}

TEST(Grbl, ReadsAMeasuredConversationWhole) {
  const std::vector<GrblMessage> messages = parse(kConversation);
  const std::vector<std::size_t> kinds = {4, 6, 3, 6, 0, 5, 5, 0, 6, 6, 0, 3, 3, 1, 2};
  ASSERT_EQ(messages.size(), kinds.size());
  for (std::size_t at = 0; at < kinds.size(); ++at)
    EXPECT_EQ(messages[at].index(), kinds[at]) << at;
}

TEST(Grbl, ReadsAStatusReport) {
  const auto jog = only<GrblStatus>("<Jog|MPos:-134.325,1.000,2.000|FS:1440,7|Ov:100,50,25>");
  EXPECT_EQ(jog.state, GrblState::kJog);
  EXPECT_DOUBLE_EQ(jog.machine_deg.value_or(0), -134.325);
  EXPECT_DOUBLE_EQ(jog.speed_deg_s.value_or(0), 24.0);
  EXPECT_EQ(jog.overrides_percent, (std::array<int, 3>{100, 50, 25}));
  EXPECT_FALSE(jog.work_deg || jog.work_offset_deg || jog.substate);
  const auto hold = only<GrblStatus>("<Hold:1|WPos:3.250|WCO:-1.5,0,0|F:90|Pn:XH|Bf:15,128>");
  EXPECT_EQ(hold.state, GrblState::kHold);
  EXPECT_EQ(hold.substate, 1);
  EXPECT_DOUBLE_EQ(hold.work_deg.value_or(0), 3.25);
  EXPECT_DOUBLE_EQ(hold.work_offset_deg.value_or(0), -1.5);
  EXPECT_DOUBLE_EQ(hold.speed_deg_s.value_or(0), 1.5);
  EXPECT_EQ(hold.active_pins, "XH");
}

TEST(Grbl, ReadsTheOtherLines) {
  EXPECT_EQ(only<GrblBanner>("Grbl 1.1h ['$' for help]").version, "1.1h");
  EXPECT_EQ(only<GrblSetting>("$110=10800.000").number, 110);
  EXPECT_FALSE(parse_grbl_line("$256=1")) << "else a hostile list of them would be without end";
  EXPECT_DOUBLE_EQ(only<GrblSetting>("$110=10800.000").value, 10800.0);
  EXPECT_EQ(only<GrblError>("error:22").code, 22);
  EXPECT_EQ(only<GrblAlarm>("ALARM:9").code, 9);
  EXPECT_EQ(only<GrblFeedback>("[OPT:V,15,128]").tag, "OPT");
  EXPECT_EQ(only<GrblFeedback>("[MSG:Caution: Unlocked]").text, "Caution: Unlocked");
}

TEST(Grbl, WhatIsNotOfTheGrammarIsNothing) {
  for (const char* line : {"",
                           "o",
                           "okay",
                           "error:",
                           "error:x",
                           "error:-1",
                           "ALARM:",
                           "ALARM:1x",
                           "<>",
                           "<Idle",
                           "Idle>",
                           "<Idel|MPos:0>",
                           "<Idle|MPos:>",
                           "<Idle|MPos:x,0,0>",
                           "<Idle|MPos:nan>",
                           "<Idle|MPos:1e999>",
                           "<Idle|FS:,0>",
                           "<Idle|Ov:1,2>",
                           "<Hold:x>",
                           "$=1",
                           "$1=",
                           "$1",
                           "$1=inf",
                           "[",
                           "<"}) {
    EXPECT_FALSE(parse_grbl_line(line)) << line;
  }
}

TEST(Grbl, AnyChoppingGivesTheSameMessages) {
  const std::string bytes = kConversation;
  const std::size_t whole = parse(bytes).size();
  for (std::size_t piece = 1; piece < bytes.size(); ++piece) {
    GrblParser parser;
    std::size_t count = 0;
    for (std::size_t at = 0; at < bytes.size(); at += piece)
      count += parser.push(bytes.substr(at, piece)).size();
    ASSERT_EQ(count, whole) << "pieces of " << piece;
    ASSERT_EQ(parser.garbage_lines(), 0U);
  }
}

TEST(Grbl, NoiseIsCountedAndTheNextLineIsReadAgain) {
  GrblParser parser;
  EXPECT_TRUE(parser.push("\xff\x01~~\r\nerr#r:9\r\n").empty());
  EXPECT_EQ(parser.garbage_lines(), 2U);
  EXPECT_EQ(parser.push("ok\r\n").size(), 1U);
}

TEST(Grbl, AnEndlessLineTakesNoMemoryAndCountsOnce) {
  GrblParser parser;
  for (int piece = 0; piece < 1000; ++piece) EXPECT_TRUE(parser.push("[MSG:endless").empty());
  EXPECT_EQ(parser.push("]\r\nok\r\n").size(), 1U);
  EXPECT_EQ(parser.garbage_lines(), 1U);
}

TEST(Grbl, RandomAndMutatedBytesNeverBreakIt) {
  std::mt19937 random(1);
  std::size_t understood = 0;
  for (int run = 0; run < 2000; ++run) {
    std::string bytes = kConversation;
    for (int change = 0; change < 8; ++change)
      bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    GrblParser parser;
    understood += parser.push(bytes).size();
    ASSERT_EQ(parser.push("\nok\n").size(), 1U);  // it is in step again after one line end
  }
  EXPECT_GT(understood, 10000U);
}

TEST(Grbl, AJogIsAbsoluteInMachineDegreesAndDegreesPerMinute) {
  EXPECT_EQ(grbl_jog_line(-134.3258, 11.25), "$J=G53 G21 X-134.326 F675.000\n");
  EXPECT_LT(grbl_jog_line(-1e6, 1e6).size(), 80U);  // GRBL's line buffer
}

TEST(Grbl, EveryCodeHasWordsThatNameIt) {
  for (int code = 0; code < 60; ++code) {
    EXPECT_THAT(grbl_error_words(code), HasSubstr("error:" + std::to_string(code) + ": "));
    EXPECT_THAT(grbl_alarm_words(code), HasSubstr("ALARM:" + std::to_string(code) + ": "));
    EXPECT_GT(grbl_alarm_words(code).size(), 25U);
  }
  EXPECT_THAT(grbl_alarm_words(9), HasSubstr("home switch"));
  EXPECT_THAT(grbl_error_words(5), HasSubstr("$22=1"));
}

}  // namespace
}  // namespace swivel
