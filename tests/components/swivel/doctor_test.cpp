// The doctor of computers that are well and of those that are not.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "components/swivel/doctor/machine.hpp"
#include "components/swivel/doctor/network.hpp"
#include "scratch_folder.hpp"
#include "tests/hardware/sim/bench_thread.hpp"

namespace swivel {
namespace {

using ::testing::HasSubstr;

TEST(Doctor, GradesAreInOrderAndAdviceComesWithWhatIsNotOk) {
  Grade last = Grade::kBad;
  for (const std::uint64_t megabytes : {0U, 64U, 250U, 400U, 4000U}) {
    const Diagnosis memory = judge_shared_memory(megabytes * 1000 * 1000);
    EXPECT_LE(memory.grade, last) << megabytes;
    EXPECT_EQ(memory.advice.empty(), memory.grade == Grade::kOk);
    last = memory.grade;
  }
  EXPECT_EQ(judge_shared_memory(64U << 20U).grade, Grade::kBad) << "Docker's default";
  EXPECT_EQ(judge_shared_memory(1U << 30U).grade, Grade::kOk);
  EXPECT_EQ(judge_disk(10'000'000, "/").grade, Grade::kBad);
  EXPECT_EQ(judge_disk(10'000'000'000, "/").grade, Grade::kOk);
  EXPECT_EQ(judge_udp_buffer(212992).grade, Grade::kWarn) << "Debian's default";
  EXPECT_THAT(judge_udp_buffer(212992).advice, HasSubstr("rmem_max=4194304"));
  EXPECT_EQ(judge_udp_buffer(4194304).grade, Grade::kOk);
  EXPECT_EQ(judge_udp_buffer(std::nullopt).grade, Grade::kWarn);
}

TEST(Doctor, TellsALivingSegmentFromWhatAKilledProcessLeft) {
  const ScratchFolder folder;
  for (const char* name : {"fastrtps_00000000000000aa", "fastrtps_00000000000000bb",
                           "fastrtps_00000000000000cc", "fastrtps_port7413", "other"}) {
    std::ofstream(folder.file(name)) << std::string(2'000'000, 'x');
    std::ofstream(folder.file(std::string(name) + "_el"));
  }
  const int living = open(folder.file("fastrtps_00000000000000bb_el").c_str(), O_RDONLY);
  ASSERT_EQ(flock(living, LOCK_EX), 0);
  const Diagnosis diagnosis = check_stale_segments(folder.path());
  EXPECT_EQ(check_other_users(folder.path()).grade, Grade::kOk);
  if (geteuid() == 0) {  // root alone can give a file away
    ASSERT_EQ(chown(folder.file("fastrtps_00000000000000bb").c_str(), 12345, 12345), 0);
    EXPECT_THAT(check_other_users(folder.path()).words, HasSubstr("user 12345"));
  }
  close(living);
  EXPECT_EQ(check_other_users(folder.path()).grade, Grade::kOk) << "nobody lives there";
  EXPECT_EQ(diagnosis.grade, Grade::kWarn);
  EXPECT_THAT(diagnosis.words, HasSubstr("2 left"));
  EXPECT_THAT(diagnosis.words, HasSubstr("4 MB"));
  EXPECT_EQ(check_stale_segments("/nowhere").grade, Grade::kOk);
}

TEST(Doctor, TellsWhyAPortIsOfNoUse) {
  const ScratchFolder folder;
  std::ofstream(folder.file("tty"));
  EXPECT_EQ(check_serial_port("stepper", folder.file("tty") + "@115200").grade, Grade::kOk);
  EXPECT_EQ(check_serial_port("stepper", "/dev/nothing_here").grade, Grade::kBad);
  if (geteuid() == 0) return;  // nothing is closed to root
  ASSERT_EQ(chmod(folder.file("tty").c_str(), 0), 0);
  EXPECT_THAT(check_serial_port("stepper", folder.file("tty")).advice, HasSubstr("dialout"));
}

// Takes connections on any free port of the loopback, and never says a word.
class MuteListener {
 public:
  MuteListener() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(socket_.get(), any, size), 0);
    EXPECT_EQ(listen(socket_.get(), 8), 0);
    EXPECT_EQ(getsockname(socket_.get(), any, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  std::string address() const { return "tcp://127.0.0.1:" + std::to_string(port_); }

 private:
  sim::FileDescriptor socket_;
  std::uint16_t port_ = 0;
};

TEST(Doctor, CallsThatALidarWhichAnswersAsOne) {
  const sim::BenchThread running{sim::BenchOptions()};
  const std::string address = "tcp://127.0.0.1:" + std::to_string(running.bench.port());
  EXPECT_THAT(check_lidar(address).words, HasSubstr("UST-10LX"));
  const MuteListener mute;
  const Diagnosis diagnosis = check_lidar(mute.address());
  EXPECT_EQ(diagnosis.grade, Grade::kBad);
  EXPECT_THAT(diagnosis.words, HasSubstr("no Hokuyo lidar"));
  EXPECT_EQ(check_stepper(mute.address()).grade, Grade::kOk);
}

nlohmann::json doctor(const ScratchFolder& folder, const std::string& arguments, int& code) {
  const int status = std::system(
      (SWIVEL_PROGRAM " doctor --json " + arguments + " >" + folder.file("out")).c_str());
  code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  nlohmann::json by_subject;
  for (const auto& diagnosis : nlohmann::json::parse(content_of(folder.file("out"))))
    by_subject[diagnosis["subject"].get<std::string>()] = diagnosis;
  return by_subject;
}

TEST(Doctor, AsAProgramSaysWhatIsWrongAndEndsWith69) {
  const ScratchFolder folder;
  std::ofstream(folder.file("broken.yaml")) << "rig: [\n";
  int code = 0;
  auto diagnoses = doctor(folder, "--lidar tcp://127.0.0.1:1 --stepper /dev/nothing_here", code);
  EXPECT_EQ(code, 69);
  EXPECT_EQ(diagnoses.size(), 10U) << diagnoses.dump();
  EXPECT_EQ(diagnoses["configuration"]["grade"], "ok");
  EXPECT_EQ(diagnoses["lidar"]["grade"], "bad");
  EXPECT_EQ(diagnoses["stepper"]["grade"], "bad");
  EXPECT_EQ(diagnoses["multicast"]["grade"], "ok");
  for (const auto& [subject, diagnosis] : diagnoses.items())
    EXPECT_EQ(diagnosis["advice"].get<std::string>().empty(), diagnosis["grade"] == "ok")
        << subject;

  diagnoses = doctor(folder, "--rig " + folder.file("broken.yaml"), code);
  EXPECT_EQ(code, 69);
  EXPECT_EQ(diagnoses["configuration"]["grade"], "bad");
  EXPECT_THAT(diagnoses["configuration"]["words"].get<std::string>(), HasSubstr("broken.yaml:"));
}

}  // namespace
}  // namespace swivel
