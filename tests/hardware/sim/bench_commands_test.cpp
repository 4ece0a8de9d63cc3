// The faults that a bench can be told to make, and how it is told. What they do to the
// participants is tested in tests/components/faults.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "hardware/io/clock.hpp"
#include "hardware/sim/bench.hpp"
#include "tests/support/own_path.hpp"

namespace swivel::sim {
namespace {

using ::testing::StartsWith;

TEST(BenchCommands, AreObeyed) {
  Bench bench{BenchOptions()};
  for (const char* command :
       {"lidar stall 0.2",       "lidar reset",          "lidar power-cycle 0.1",
        "lidar stamp 16777215",  "lidar drop 1",         "lidar half 1",
        "lidar bad-sums 2",      "lidar wrong-echo 3",   "lidar status 0M 2",
        "stepper silent 0.1",    "stepper delay 500",    "stepper reset",
        "stepper alarm 1",       "stepper lose 12.5",    "stepper switch open",
        "stepper switch closed", "stepper switch works", "stepper unplug 0.1",
        "truth lines",           "truth shaft"}) {
    EXPECT_THAT(bench.obey(command, now_ns()), StartsWith("ok")) << command;
  }
}

TEST(BenchCommands, AreRefusedWhenTheyMakeNoSense) {
  Bench bench{BenchOptions()};
  for (const char* command : {"",
                              " ",
                              "lidar",
                              "lidar stall",
                              "lidar stall x",
                              "lidar stall -1",
                              "lidar stall nan",
                              "lidar stall 1e9",
                              "lidar status 0M",
                              "lidar status M 1",
                              "lidar stamp 16777216",
                              "stepper",
                              "stepper alarm 0",
                              "stepper alarm 11",
                              "stepper switch",
                              "stepper switch on",
                              "stepper unplug",
                              "truth",
                              "truth beams",
                              "lidars reset"}) {
    EXPECT_THAT(bench.obey(command, now_ns()), StartsWith("error: ")) << command;
  }
}

TEST(BenchCommands, LostStepsLeaveTheShaftBehind) {
  Bench bench{BenchOptions()};
  const std::int64_t time_ns = now_ns();
  const auto angle_deg = [&] {
    double angle = 0.0;
    const std::string answer = bench.obey("truth shaft", time_ns);
    return std::sscanf(answer.c_str(), "ok %*d %lf", &angle) == 1 ? angle : 1e9;
  };
  const double before_deg = angle_deg();
  bench.obey("stepper lose 12.5", time_ns);
  EXPECT_NEAR(angle_deg(), before_deg - 12.5, 0.01);
}

TEST(ControlPort, IsItsOwnersAlone) {
  const std::string path = own_path("control");
  {
    const ControlPort port(path);
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600U);
  }
  EXPECT_NE(::access(path.c_str(), F_OK), 0);
}

TEST(ControlPort, SaysWhyItCannotBe) {
  EXPECT_THROW(ControlPort("/no/such/folder/control"), std::system_error);
  EXPECT_THROW(ControlPort(std::string(200, 'x')), std::system_error);
}

TEST(ControlPort, TakesLinesHoweverTheyAreCutAndNoEndlessOne) {
  const std::string path = own_path("control_lines");
  ControlPort port(path);
  const FileDescriptor client(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  std::vector<std::string> lines;
  const auto obey = [&](const std::string& line) { return lines.push_back(line), "ok"; };
  for (const char* piece : {"ab", "c\nde\n", "f\n"}) {
    ::send(client.get(), piece, std::char_traits<char>::length(piece), 0);
    port.serve(obey);
  }
  EXPECT_THAT(lines, ::testing::ElementsAre("abc", "de", "f"));
  char answers[16] = {};
  EXPECT_EQ(::recv(client.get(), answers, sizeof answers, 0), 9);
  const std::string endless(300, 'x');
  ::send(client.get(), endless.data(), endless.size(), 0);
  port.serve(obey);
  EXPECT_EQ(::recv(client.get(), answers, sizeof answers, 0), 0);
}

}  // namespace
}  // namespace swivel::sim
