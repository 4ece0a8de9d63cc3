// The controller's behaviour as it was seen on the firmware, in time that is only told.
#include "hardware/sim/grbl_peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swivel::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kBanner = "\r\nGrbl 1.1h ['$' for help]\r\n";
constexpr const char* kUnlockHint = "[MSG:'$H'|'$X' to unlock]\r\n";

class Controller {
 public:
  explicit Controller(const MotorOptions& options = {}) : peer_(options, 1, 0) {}

  std::string wait(double duration_s) {
    const auto end_ns = now_ns_ + std::llround(duration_s * 1e9);
    while (now_ns_ < end_ns) {
      now_ns_ += 1'000'000;
      peer_.advance(now_ns_);
    }
    return peer_.take_output();
  }
  std::string send(const std::string& bytes) {
    peer_.receive(bytes, now_ns_);
    return peer_.take_output();
  }
  std::string wait_idle() {
    std::string said;
    for (int i = 0; i < 60'000 && peer_.busy(now_ns_); ++i) said += wait(0.001);
    return said;
  }
  void unlock() {
    wait(1.0);
    send("$X\n");
    send("?");
    send("?");  // the reports with WCO and Ov
  }
  double shaft_deg() const { return peer_.shaft_angle_deg(now_ns_); }
  GrblPeer& peer() { return peer_; }

 private:
  GrblPeer peer_;
  std::int64_t now_ns_ = 0;
};

TEST(GrblPeer, GreetsAndIsLockedAfterPowerUp) {
  Controller grbl;
  EXPECT_EQ(grbl.send("?$$\n"), "");  // still starting: not even read
  EXPECT_EQ(grbl.wait(1.0), std::string(kBanner) + kUnlockHint);
  EXPECT_THAT(grbl.send("?"), StartsWith("<Alarm|MPos:0.000,0.000,0.000|FS:0,0"));
  EXPECT_EQ(grbl.send("G1 X1 F100\n"), "error:9\r\n");
  EXPECT_EQ(grbl.send("$J=G91 X1 F100\n"), "error:8\r\n");
  EXPECT_EQ(grbl.send("$X\n"), "[MSG:Caution: Unlocked]\r\nok\r\n");
  EXPECT_THAT(grbl.send("?"), StartsWith("<Idle|"));
}

TEST(GrblPeer, WithoutHomingItIsNotLocked) {
  Controller grbl;
  grbl.unlock();
  EXPECT_EQ(grbl.send("$22=0\n"), "ok\r\n");
  EXPECT_EQ(grbl.send("\x18"), "");
  EXPECT_EQ(grbl.wait(0.05), kBanner);
  EXPECT_EQ(grbl.send("$H\n"), "error:5\r\n");
}

TEST(GrblPeer, ListsSettingsAndBuild) {
  Controller grbl;
  grbl.unlock();
  const std::string settings = grbl.send("$$\n");
  for (const char* line : {"$22=1\r\n", "$27=1.000\r\n", "$100=88.889\r\n", "$110=12000.000\r\n",
                           "$120=720.000\r\n", "$130=360.000\r\n"}) {
    EXPECT_THAT(settings, HasSubstr(line));
  }
  EXPECT_THAT(settings, ::testing::EndsWith("\r\nok\r\n"));
  EXPECT_THAT(grbl.send("$I\n"), HasSubstr("[OPT:V,15,128]\r\nok\r\n"));
  EXPECT_EQ(grbl.send("$120=500.5\n"), "ok\r\n");
  EXPECT_THAT(grbl.send("$$\n"), HasSubstr("$120=500.500\r\n"));
}

TEST(GrblPeer, ReportsOffsetFirstThenOverridesThenEveryTenth) {
  Controller grbl;
  grbl.wait(1.0);
  grbl.send("$X\n");
  EXPECT_THAT(grbl.send("?"), HasSubstr("|WCO:0.000,0.000,0.000>"));
  EXPECT_THAT(grbl.send("?"), HasSubstr("|Ov:100,100,100>"));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(grbl.send("?"), "<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n");
  EXPECT_THAT(grbl.send("?"), HasSubstr("|WCO:"));
}

TEST(GrblPeer, AnswersErrors) {
  Controller grbl;
  grbl.unlock();
  const std::pair<const char*, const char*> cases[] = {
      {"$J=G91 X F100\n", "error:2"}, {"$Q\n", "error:3"},
      {"$J=G91 X10\n", "error:22"},   {"$J=G91 F100\n", "error:26"},
      {"G1 X10\n", "error:22"},       {"$J=G1 X10 F100\n", "error:16"},
      {"G77 X1\n", "error:20"},       {"$120=abc\n", "error:2"},
      {"$999=1\n", "error:3"},        {"%&!\n", "error:1"},
      {"X1e30F1\n", "error:20"},      {"$J=X99999999999999999 F1\n", "error:15"},
      {"$J=X1 F0\n", "error:22"}};
  for (const auto& [line, error] : cases) {
    EXPECT_EQ(grbl.send(line), std::string(error) + "\r\n") << line;
    grbl.send("~");
  }
  EXPECT_EQ(grbl.send(std::string(100, 'X') + "\n"), "error:11\r\n");
  EXPECT_EQ(grbl.send("\n"), "ok\r\n");
}

TEST(GrblPeer, JogsAndSaysSo) {
  Controller grbl;
  grbl.unlock();
  const double before = grbl.shaft_deg();
  EXPECT_EQ(grbl.send("$J=G91 G21 X90 F1800\r\n"), "ok\r\nok\r\n");  // CR, then the empty line
  grbl.wait(1.5);
  EXPECT_THAT(grbl.send("?"), HasSubstr("|FS:1800,0"));
  EXPECT_EQ(grbl.send("G1 X1 F100\n"), "error:9\r\n");
  EXPECT_EQ(grbl.send("$$\n"), "error:8\r\n");
  EXPECT_EQ(grbl.wait_idle(), "");
  EXPECT_THAT(grbl.send("?"), StartsWith("<Idle|MPos:90.0"));
  EXPECT_NEAR(grbl.shaft_deg() - before, 90.0, 1e-9);
  grbl.send("$J=G53 X10 F12000\n");
  grbl.wait_idle();
  EXPECT_NEAR(grbl.shaft_deg() - before, 10.0, 0.012);
  grbl.send("$J=G90 X-20 F12000\n");
  grbl.wait_idle();
  EXPECT_NEAR(grbl.shaft_deg() - before, -20.0, 0.012);
}

TEST(GrblPeer, SpeedIsLimitedByItsSetting) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$110=600\n");
  grbl.send("$J=G91 X90 F1800\n");
  grbl.wait(1.0);
  EXPECT_THAT(grbl.send("?"), HasSubstr("|FS:600,0"));
}

TEST(GrblPeer, JogCancelSlowsDownAndForgetsTheRest) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$J=G91 X90 F10800\n$J=G91 X90 F10800\n");
  grbl.wait(0.5);
  const double before = grbl.shaft_deg();
  EXPECT_EQ(grbl.send("\x85"), "");
  EXPECT_EQ(grbl.wait(0.24), "");
  EXPECT_THAT(grbl.send("?"), StartsWith("<Jog|"));
  grbl.wait(0.02);  // 180 deg/s at 720 deg/s^2: 0.25 s, 22.5 deg
  EXPECT_THAT(grbl.send("?"), StartsWith("<Idle|"));
  EXPECT_NEAR(grbl.shaft_deg() - before, 22.5, 0.02);
  grbl.wait(2.0);
  EXPECT_NEAR(grbl.shaft_deg() - before, 22.5, 0.02);
  grbl.send("$J=G91 X1 F10800\n");  // nothing of the cancelled moves comes back with it
  grbl.wait_idle();
  EXPECT_NEAR(grbl.shaft_deg() - before, 23.5, 0.03);
}

TEST(GrblPeer, HoldPausesAMoveAndEndsAJog) {
  Controller grbl;
  grbl.unlock();
  const double before = grbl.shaft_deg();
  EXPECT_EQ(grbl.send("G91\nG1 X90 F5400\n"), "ok\r\nok\r\n");
  grbl.wait(0.5);
  EXPECT_THAT(grbl.send("!?"), StartsWith("<Hold:1|"));
  grbl.wait(0.3);
  EXPECT_THAT(grbl.send("?"), StartsWith("<Hold:0|"));
  EXPECT_LT(grbl.shaft_deg() - before, 60.0);
  EXPECT_THAT(grbl.send("~?"), StartsWith("<Run|"));
  grbl.wait_idle();
  EXPECT_NEAR(grbl.shaft_deg() - before, 90.0, 0.012);
  EXPECT_THAT(grbl.send("!?"), StartsWith("<Hold:0|"));
  EXPECT_THAT(grbl.send("~?"), StartsWith("<Idle|"));
  grbl.send("$J=G91 X90 F5400\n");
  grbl.wait(0.3);
  grbl.send("!");
  grbl.wait(0.5);
  EXPECT_THAT(grbl.send("?"), StartsWith("<Idle|"));
}

TEST(GrblPeer, ResetInMotionIsAnAlarmAndSilence) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$J=G91 X90 F5400\n");
  grbl.wait(0.5);
  EXPECT_EQ(grbl.send("\x18"), "ALARM:3\r\n");
  const double stopped = grbl.shaft_deg();
  EXPECT_EQ(grbl.wait(0.49), "");
  EXPECT_EQ(grbl.wait(0.02), std::string(kBanner) + kUnlockHint);
  EXPECT_NEAR(grbl.shaft_deg(), stopped, 0.012);
  EXPECT_THAT(grbl.send("?"), Not(HasSubstr("MPos:0.000")));
  EXPECT_EQ(grbl.send("$X\n"), "[MSG:Caution: Unlocked]\r\nok\r\n");
}

TEST(GrblPeer, HomesInSilenceAndKnowsWhereItIs) {
  Controller grbl;
  grbl.wait(1.0);
  EXPECT_EQ(grbl.send("$H\n"), "");
  EXPECT_EQ(grbl.wait(1.0), "");
  EXPECT_EQ(grbl.send("?"), "");
  EXPECT_THAT(grbl.wait(1.9), StartsWith("<Home|"));  // between two phases
  EXPECT_EQ(grbl.wait(1.05), "");
  EXPECT_EQ(grbl.wait(0.1), "ok\r\n");
  EXPECT_THAT(grbl.send("?"), StartsWith("<Idle|MPos:-35"));
  EXPECT_NEAR(grbl.shaft_deg(), -75.0, 4 * 0.35);
}

TEST(GrblPeer, HomingPositionFollowsItsSettings) {
  Controller grbl;
  grbl.unlock();
  for (const char* setting : {"$100=100\n", "$27=2\n", "$130=300\n"}) grbl.send(setting);
  grbl.send("$H\n");
  grbl.wait_idle();
  EXPECT_THAT(grbl.send("?"), HasSubstr("MPos:-298.000,"));
  grbl.send("$23=0\n$H\n");
  grbl.wait_idle();
  EXPECT_THAT(grbl.send("?"), HasSubstr("MPos:-2.000,"));
}

TEST(GrblPeer, HomingWithoutASwitchIsAlarmNine) {
  MotorOptions options;
  options.switch_works = false;
  Controller grbl(options);
  grbl.wait(1.0);
  grbl.send("$H\n");
  const std::string said = grbl.wait_idle();
  EXPECT_EQ(said, std::string("ALARM:9\r\n") + kBanner + kUnlockHint);
}

TEST(GrblPeer, SoftLimitsRefuseAJogAndStopAMove) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$20=1\n$H\n");
  grbl.wait_idle();
  EXPECT_EQ(grbl.send("$J=G91 X400 F1000\n"), "error:15\r\n");
  EXPECT_EQ(grbl.send("$J=G91 X10 F1000\n"), "ok\r\n");
  grbl.wait_idle();
  EXPECT_EQ(grbl.send("G53 G1 X10 F1000\n"), "ALARM:2\r\n");
  EXPECT_EQ(grbl.wait(0.49), "");
  EXPECT_EQ(grbl.wait(0.02), "[MSG:Reset to continue]\r\n");
  EXPECT_EQ(grbl.send("?$X\n!~"), "");
  EXPECT_EQ(grbl.wait(5.0), "");
  EXPECT_EQ(grbl.send("\x18"), "");
  EXPECT_EQ(grbl.wait(0.05), std::string(kBanner) + kUnlockHint);
}

TEST(GrblPeer, HardLimitStopsTheMotorAtTheSwitch) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$21=1\n$H\n");
  grbl.wait_idle();
  grbl.send("$J=G91 X-30 F1200\n");
  const std::string said = grbl.wait(1.0);
  EXPECT_EQ(said, "ALARM:1\r\n[MSG:Reset to continue]\r\n");
  EXPECT_GT(grbl.shaft_deg(), -78.0);
  EXPECT_EQ(grbl.send("?"), "");
  grbl.send("\x18");
  grbl.wait(0.1);
  EXPECT_THAT(grbl.send("?"), HasSubstr("|Pn:X"));
}

TEST(GrblPeer, SleepsUntilReset) {
  Controller grbl;
  grbl.unlock();
  EXPECT_EQ(grbl.send("$SLP\n"), "ok\r\n[MSG:Sleeping]\r\n");
  EXPECT_THAT(grbl.send("?"), StartsWith("<Sleep|"));
  EXPECT_EQ(grbl.send("$X\n"), "");
  grbl.send("\x18");
  EXPECT_EQ(grbl.wait(0.1), std::string(kBanner) + kUnlockHint);
}

TEST(GrblPeer, QueuesFifteenMovesThenKeepsSilent) {
  Controller grbl;
  grbl.unlock();
  std::string answers;
  for (int i = 0; i < 17; ++i) answers += grbl.send("$J=G91X1F60\n");
  EXPECT_EQ(answers.size(), 15 * std::string("ok\r\n").size());
  EXPECT_EQ(grbl.wait(1.2), "ok\r\n");  // one move done, one more taken
  EXPECT_EQ(grbl.wait_idle(), "ok\r\n");
}

TEST(GrblPeer, LosesAndCountsWhatDoesNotFitItsBuffer) {
  Controller grbl;
  grbl.unlock();
  for (int i = 0; i < 15; ++i) grbl.send("$J=G91X1F60\n");
  grbl.send(std::string(200, 'X'));
  EXPECT_EQ(grbl.peer().bytes_lost(), 200U - 127U);
  EXPECT_THAT(grbl.send("?"), StartsWith("<Jog|"));  // single bytes still get through
}

TEST(GrblPeer, PositionCountsStepsNotTheShaft) {
  MotorOptions options;
  options.lose_every = 50;
  Controller grbl(options);
  grbl.unlock();
  const double before = grbl.shaft_deg();
  grbl.send("$J=G91 X180 F10800\n");
  grbl.wait_idle();
  EXPECT_THAT(grbl.send("?"), HasSubstr("MPos:180.0"));
  EXPECT_NEAR(grbl.shaft_deg() - before, 176.4, 0.02);
}

TEST(GrblPeer, OpeningItsPortResetsItAndStopsTheMotor) {
  Controller grbl;
  grbl.unlock();
  grbl.send("$J=G91 X180 F1080\n");
  grbl.wait(2.0);
  grbl.peer().power_up(3'000'000'000);
  const double stopped = grbl.shaft_deg();
  EXPECT_EQ(grbl.wait(1.0), std::string(kBanner) + kUnlockHint);
  EXPECT_NEAR(grbl.shaft_deg(), stopped, 0.02);
  EXPECT_THAT(grbl.send("?"), HasSubstr("MPos:0.000"));
}

double machine_position_deg(const std::string& report) {
  return std::stod(report.substr(report.find("MPos:") + 5));
}

// A pan unit measures: what it says is where the shaft is, lost steps or not.
TEST(GrblPeer, WithAnEncoderThePositionIsThatOfTheShaft) {
  MotorOptions options;
  options.home_sigma_deg = 3.0;
  options.lose_every = 50;
  options.lose_after_s = 6.0;
  options.encoder = {true, 0.01, 0.5, 4.0};
  Controller grbl(options);
  grbl.unlock();
  grbl.send("$H\n");
  grbl.wait_idle();
  const double home_deg = grbl.shaft_deg();
  grbl.wait(3.0);
  grbl.send("$J=G91 X90 F5400\n");
  double largest_deg = 0.0;
  for (int i = 0; i < 100; ++i) {
    grbl.send("?");
    const double asked_deg = grbl.shaft_deg();
    const std::string report = grbl.wait(0.005);
    const double said_deg = home_deg + machine_position_deg(report) + 359.0;
    EXPECT_GT(said_deg, asked_deg - 0.02);
    EXPECT_LT(said_deg, grbl.shaft_deg() + 0.02);
    largest_deg = std::max(largest_deg, said_deg - asked_deg);
  }
  EXPECT_GT(largest_deg, 0.1);  // of an instant after the question: 4 ms at 90 deg/s
  grbl.wait_idle();
  grbl.send("?");
  EXPECT_NEAR(machine_position_deg(grbl.wait(0.005)), -359.0 + 90.0 * 49 / 50, 0.02);
}

TEST(GrblPeer, SurvivesAnyBytes) {
  Controller grbl;
  Random random(1);
  const std::string alphabet = "$JGXFH=90.1-\n\r?!~\x18\x85 ZN#I";
  std::string said;
  for (int i = 0; i < 20'000; ++i) {
    const double draw = random.uniform(0.0, static_cast<double>(alphabet.size() + 2));
    const auto choice = static_cast<std::size_t>(draw);
    said += grbl.send(
        choice < alphabet.size()
            ? std::string(1, alphabet[choice])
            : std::string(1, static_cast<char>(static_cast<int>(random.uniform(0.0, 255.0)))));
    said += grbl.wait(0.003);
  }
  EXPECT_THAT(said, HasSubstr("error:"));
  grbl.send("\x18\x18");
  grbl.wait(2.0);
  grbl.send("\x18");
  EXPECT_THAT(grbl.wait(2.0), HasSubstr("Grbl 1.1h"));
}

}  // namespace
}  // namespace swivel::sim
