// The sensor's side of SCIP without sockets, in time that is only told.
#include "hardware/sim/scip_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hardware/sim/scip_replies_by_hand.hpp"

namespace swivel::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Sensor {
 public:
  explicit Sensor(const SensorModel& model = {}) : sensor(model, timing, 80'000'000) {}
  std::string ask(const std::string& request) { return sensor.receive(request + "\n", now_ns); }
  LidarTiming timing{LidarTimingOptions{}, 0, 1440, 1080, 1};
  ScipSensor sensor;
  std::int64_t now_ns = 1'000'000'000;
};

// As if beam k measured 1000 + k mm, at an intensity of 3 k.
LineReading ramp() {
  LineReading line;
  for (std::uint16_t k = 0; k <= 1080; ++k) {
    line.ranges_mm.push_back(static_cast<std::uint16_t>(1000 + k));
    line.intensities.push_back(static_cast<std::uint16_t>(3 * k));
  }
  return line;
}

TEST(ScipSensor, KnowsTheSumsOfTheSpecification) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("QT"), "QT\n00P\n\n");
  EXPECT_EQ(lidar.ask("XY"), "XY\n0Ff\n\n");
  EXPECT_EQ(lidar.ask("BM"), "BM\n00P\n\n");
  EXPECT_EQ(lidar.ask("BM"), "BM\n02R\n\n");
}

TEST(ScipSensor, EndsRequestsWithLfCrOrBothInAnyPieces) {
  Sensor lidar;
  EXPECT_EQ(lidar.sensor.receive("\n\r\n", 0), "");
  EXPECT_EQ(lidar.sensor.receive("Q", 0), "");
  EXPECT_EQ(lidar.sensor.receive("T\rQT\r\n", 0), "QT\n00P\n\nQT\n00P\n\n");
  EXPECT_EQ(lidar.sensor.receive("\n", 0), "");
}

TEST(ScipSensor, EchoesTheStringOfARequest) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("QT;hello"), "QT;hello\n00P\n\n");
  EXPECT_THAT(lidar.ask("QT;12345678901234567"), HasSubstr("\n0G"));
  EXPECT_THAT(lidar.ask(std::string(500, 'Q')), HasSubstr("\n0D"));
}

TEST(ScipSensor, DoesNotAnswerTheOldCommandsOfOtherSensors) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("MS0000108001000"), "");
  EXPECT_EQ(lidar.ask("GS0000108001"), "");
}

TEST(ScipSensor, RefusesBadScanRequestsWithTheirCodes) {
  Sensor lidar;
  const std::pair<const char*, const char*> cases[] = {
      {"MDxx00108001000", "01Q"}, {"MD0000x08001000", "02R"}, {"MD00001080x1000", "03S"},
      {"MD0000108101000", "04T"}, {"MD0500040001000", "05U"}, {"MD0000108001x00", "06V"},
      {"MD00001080010x0", "07W"}, {"MD0000", "0Hx"},          {"MD00001080010000", "0Dt"}};
  for (const auto& [request, status] : cases) {
    EXPECT_EQ(lidar.ask(request), std::string(request) + "\n" + std::string(status, 2) +
                                      sum_of(std::string(status, 2)) + "\n\n");
  }
  EXPECT_FALSE(lidar.sensor.wanted_scan());
}

TEST(ScipSensor, CountsDownTheScansInTheEcho) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("MD0000108001003;id"), "MD0000108001003;id\n00P\n\n");
  for (const char* echo : {"MD0000108001002;id", "MD0000108001001;id", "MD0000108001000;id"}) {
    ASSERT_TRUE(lidar.sensor.wanted_scan());
    EXPECT_EQ(lines_of(lidar.sensor.deliver(ramp()).front()).front(), echo);
  }
  EXPECT_FALSE(lidar.sensor.wanted_scan());
}

TEST(ScipSensor, EndlessScansKeepTheirEchoAndFollowOneAnother) {
  Sensor lidar;
  lidar.ask("MD0000108001000");
  const auto first = *lidar.sensor.wanted_scan();
  EXPECT_GE(lidar.timing.beam0_time_ns(first), lidar.now_ns + 80'000'000);
  for (std::uint64_t scan = first; scan < first + 120; ++scan) {
    ASSERT_EQ(lidar.sensor.wanted_scan(), scan);
    const auto frames = lidar.sensor.deliver(ramp());
    ASSERT_EQ(lines_of(frames.front()).front(), "MD0000108001000");
    ASSERT_EQ(value_of(lines_of(frames.front())[2].substr(0, 4)), lidar.timing.stamp_ms(scan));
  }
}

TEST(ScipSensor, FramesHoldWhatWasMeasured) {
  Sensor lidar;
  lidar.ask("MD0000108001001");
  const std::string ranges = lidar.sensor.deliver(ramp()).front();
  const std::size_t after_stamp = 16 + 4 + 6;
  EXPECT_EQ(ranges.size() - after_stamp, 3346U);
  EXPECT_TRUE(sums_hold(ranges, true));
  const auto values = values_of(ranges, 3);
  ASSERT_EQ(values.size(), 1081U);
  EXPECT_EQ(values.front(), 1000U);
  EXPECT_EQ(values.back(), 2080U);
  lidar.ask("ME0100020001001");
  const auto both = values_of(lidar.sensor.deliver(ramp()).front(), 3);
  ASSERT_EQ(both.size(), 202U);
  EXPECT_EQ(both[0], 1100U);
  EXPECT_EQ(both[1], 300U);
  EXPECT_EQ(both[201], 600U);
}

TEST(ScipSensor, ClustersBeamsAndSkipsScans) {
  Sensor lidar;
  lidar.ask("MD0000108010200");
  const auto first = *lidar.sensor.wanted_scan();
  const auto values = values_of(lidar.sensor.deliver(ramp()).front(), 3);
  EXPECT_EQ(values.size(), 109U);
  EXPECT_EQ(values[1], 1010U);
  EXPECT_EQ(lidar.sensor.wanted_scan(), first + 3);
}

TEST(ScipSensor, SingleScansNeedTheLaser) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("GD0000108001"), "GD0000108001\n10Q\n\n");
  lidar.ask("BM");
  EXPECT_EQ(lidar.ask("GE0000108000"), "");
  const std::string frame = lidar.sensor.deliver(ramp()).front();
  EXPECT_THAT(frame, ::testing::StartsWith("GE0000108000\n00P\n"));
  EXPECT_EQ(values_of(frame, 3).size(), 2162U);
  EXPECT_FALSE(lidar.sensor.wanted_scan());
}

TEST(ScipSensor, ANewClientIsLeftInPeace) {
  Sensor lidar;
  lidar.ask("MD0000108001000");
  lidar.sensor.receive("GD00", lidar.now_ns);
  lidar.sensor.connect();
  EXPECT_FALSE(lidar.sensor.wanted_scan());
  EXPECT_EQ(lidar.ask("QT"), "QT\n00P\n\n");
}

TEST(ScipSensor, TellsItsClock) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("TM0"), "TM0\n00P\n\n");
  EXPECT_EQ(lidar.ask("TM0"), "TM0\n02R\n\n");
  const std::string reply = lidar.ask("TM1");
  EXPECT_TRUE(sums_hold(reply, true));
  EXPECT_EQ(value_of(lines_of(reply)[2].substr(0, 4)), 1'001'000U);
  EXPECT_EQ(lidar.ask("MD0000108001000"), "MD0000108001000\n10Q\n\n");
  EXPECT_EQ(lidar.ask("TM2"), "TM2\n00P\n\n");
  EXPECT_EQ(lidar.ask("TM2"), "TM2\n03S\n\n");
  lidar.ask("MD0000108001000");
  EXPECT_EQ(lidar.ask("TM0"), "TM0\n10Q\n\n");
}

TEST(ScipSensor, ResetStopsAndStartsTheClockAnew) {
  Sensor lidar;
  lidar.ask("MD0000108001000");
  EXPECT_EQ(lidar.ask("RS"), "RS\n00P\n\n");
  EXPECT_FALSE(lidar.sensor.wanted_scan());
  EXPECT_EQ(lidar.timing.counter_ms(lidar.now_ns), 0U);
  EXPECT_EQ(lidar.ask("RT"), "RT\n00P\n\n");
}

TEST(ScipSensor, RebootsWhenToldTwiceWithinASecond) {
  Sensor lidar;
  EXPECT_EQ(lidar.ask("RB"), "RB\n01Q\n\n");
  lidar.now_ns += 1'100'000'000;
  EXPECT_EQ(lidar.ask("RB"), "RB\n01Q\n\n");
  EXPECT_FALSE(lidar.sensor.reboot_requested());
  lidar.now_ns += 900'000'000;
  EXPECT_EQ(lidar.ask("RB"), "RB\n00P\n\n");
  EXPECT_TRUE(lidar.sensor.reboot_requested());
}

// As programs that read these sensors quote their answers.
TEST(ScipSensor, SaysOfItselfWhatItsModelSays) {
  Sensor utm(sensor_model("UTM-30LX").value());
  EXPECT_THAT(utm.ask("PP"), AllOf(HasSubstr("MODL:UTM-30LX;"), HasSubstr("DMIN:23;7\n"),
                                   HasSubstr("DMAX:60000;J\n"), HasSubstr("AMAX:1080;Z\n")));
  EXPECT_THAT(utm.ask("VV"), HasSubstr("PROD:UTM-30LX;"));
  EXPECT_THAT(utm.ask("II"), HasSubstr("SCSP:2400;"));
  Sensor urg(sensor_model("URG-04LX").value());
  EXPECT_THAT(urg.ask("PP"), AllOf(HasSubstr("ARES:1024;"), HasSubstr("AMIN:44;"),
                                   HasSubstr("AMAX:725;"), HasSubstr("SCAN:600;")));
  EXPECT_THAT(urg.ask("VV"), HasSubstr("PROT:SCIP 2.0;"));
  EXPECT_FALSE(sensor_model("UST-10").has_value());
}

TEST(ScipSensor, OfAFanThatBeginsLaterSendsTheStepsAskedFor) {
  Sensor urg(sensor_model("URG-04LX").value());
  EXPECT_THAT(urg.ask("MD0000072501000"), HasSubstr("\n04"));
  EXPECT_THAT(urg.ask("ME0044072501000"), HasSubstr("\n0E"));  // it has no intensities
  EXPECT_THAT(urg.ask("MD0050072501001"), HasSubstr("\n00P"));
  LineReading line = ramp();
  line.ranges_mm.resize(682);
  const auto frames = urg.sensor.deliver(line);
  ASSERT_EQ(frames.size(), 1U);
  const auto values = values_of(frames[0], 3);
  EXPECT_EQ(values.size(), 676U);
  EXPECT_EQ(values.front(), 1006U);  // step 50 is the seventh of the fan
  EXPECT_EQ(values.back(), 1681U);
}

TEST(ScipSensor, TellsItsOperatingState) {
  Sensor lidar;
  const auto state = [&] { return lines_of(lidar.ask("%ST"))[2].substr(0, 3); };
  EXPECT_EQ(state(), "000");
  lidar.ask("BM");
  EXPECT_EQ(state(), "003");
  lidar.ask("MD0000108001000");
  EXPECT_EQ(state(), "004");
  lidar.ask("QT");
  lidar.ask("TM0");
  EXPECT_EQ(state(), "002");
  lidar.ask("TM2");
  lidar.ask("%SL");
  EXPECT_EQ(state(), "005");
}

}  // namespace
}  // namespace swivel::sim
