#include "components/dds/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "swivel/idl/point_cloud2TypeObject.h"
#include "tests/components/dds/test_participant.hpp"
#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

namespace fast = eprosima::fastdds::dds;
using ::testing::AllOf;
using ::testing::HasSubstr;

// A process that sends clouds; ends with the object.
class CloudSender {
 public:
  CloudSender(int domain, int count, const std::string& profiles = kProfiles) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      close(ends[0]);
      close(ends[1]);
      execl(CLOUD_SENDER, "cloud_sender", std::to_string(domain).c_str(),
            std::to_string(count).c_str(), profiles.c_str(), nullptr);
      _exit(127);
    }
    close(ends[0]);
    input_ = ends[1];
  }
  ~CloudSender() { end(); }

  int end() {
    if (child_ == 0) return 0;
    close(input_);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return status;
  }
  void kill_at_once() { kill(child_, SIGKILL); }

 private:
  pid_t child_ = 0;
  int input_ = -1;
};

// The shipped profiles, but that no writer is reliable.
std::string best_effort_profiles() {
  std::ifstream shipped(kProfiles);
  std::ostringstream whole;
  whole << shipped.rdbuf();
  std::string text = whole.str();
  const std::string reliable = "<kind>RELIABLE</kind><max_blocking_time>";
  for (std::size_t at = 0; (at = text.find(reliable, at)) != std::string::npos;) {
    text.replace(at, reliable.size(), "<kind>BEST_EFFORT</kind><max_blocking_time>");
  }
  const std::string path = own_path("best_effort_profiles.xml");
  std::ofstream(path) << text;
  return path;
}

// A pipeline once took the sweeps of another test's: 130 domains, by process id alone.
TEST(DomainOfThisTest, IsNobodyElses) {
  const std::string lock = "/tmp/swivel_test_domain_" + std::to_string(domain_of_this_test());
  const int other = open(lock.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(other, 0);
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  close(other);
}

TEST(Participant, CarriesCloudsOf11MegabytesBetweenProcessesWhole) {
  const int domain = domain_of_this_test();
  Participant participant(loopback_participant("receiver", domain));
  Seen<PointCloud2> clouds;
  participant.subscribe<PointCloud2>(kRawCloudTopic, [&](const auto& cloud) { clouds.add(cloud); });
  participant.start();
  CloudSender sender(domain, 6);
  ASSERT_TRUE(wait_until([&] { return clouds.values().size() >= 6; })) << clouds.values().size();
  int number = 0;
  for (const PointCloud2& cloud : clouds.values()) EXPECT_TRUE(cloud == numbered_cloud(++number));
  EXPECT_EQ(participant.samples_lost(), 0U);
  EXPECT_EQ(sender.end(), 0);
}

TEST(Participant, GivesTheLastCloudsToAReaderThatJoinsLate) {
  const int domain = domain_of_this_test();
  CloudSender sender(domain, 3);
  Seen<int> early;
  Participant first(loopback_participant("first", domain));
  first.subscribe<PointCloud2>(kRawCloudTopic,
                               [&](const auto& cloud) { early.add(cloud.header().stamp().sec()); });
  first.start();
  ASSERT_TRUE(wait_until([&] { return !early.values().empty() && early.values().back() == 3; }));

  Participant late(loopback_participant("late", domain));
  Seen<PointCloud2> clouds;
  late.subscribe<PointCloud2>(kRawCloudTopic, [&](const auto& cloud) { clouds.add(cloud); });
  late.start();
  ASSERT_TRUE(wait_until([&] { return clouds.values().size() == 2; }));
  EXPECT_TRUE(clouds.values().front() == numbered_cloud(2));
  EXPECT_TRUE(clouds.values().back() == numbered_cloud(3));
}

// RELIABLE alone loses the first samples now and then: matched is not ready.
TEST(Participant, GivesAStreamFromItsFirstSampleToAReaderThatJoinsLate) {
  const int domain = domain_of_this_test();
  Participant sender(loopback_participant("sender", domain));
  Writer<msg::ScanLine> lines(sender, kScanLineTopic);
  sender.start();
  for (int i = 0; i < 300; ++i) lines.write(msg::ScanLine());

  Participant receiver(loopback_participant("receiver", domain));
  Seen<std::uint64_t> numbers;
  receiver.subscribe<msg::ScanLine>(kScanLineTopic,
                                    [&](const auto& line) { numbers.add(line.sequence_number()); });
  receiver.start();
  ASSERT_TRUE(wait_until([&] { return numbers.values().size() >= 300; }));
  for (std::uint64_t i = 0; i < 300; ++i) ASSERT_EQ(numbers.values()[i], i + 1);
  EXPECT_EQ(receiver.samples_lost(), 0U);
}

TEST(Participant, CountsAHoleInTheSequenceAsALoss) {
  const int domain = domain_of_this_test();
  Participant sender(loopback_participant("sender", domain));
  Participant receiver(loopback_participant("receiver", domain));
  Writer<msg::Axis> axis(sender, kAxisTopic);
  Seen<std::uint64_t> numbers;
  Seen<std::string> problems;
  receiver.on_problem([&](const std::string& problem) { problems.add(problem); });
  // The reader is held in its callback until the writer's history of 750 has run over.
  std::atomic<bool> hold{true};
  receiver.subscribe<msg::Axis>(kAxisTopic, [&](const auto& message) {
    numbers.add(message.sequence_number());
    while (hold) usleep(1000);
  });
  sender.start();
  receiver.start();
  axis.write(msg::Axis());
  ASSERT_TRUE(wait_until([&] { return numbers.values().size() == 1; }));
  for (int i = 0; i < 1200; ++i) axis.write(msg::Axis());
  ASSERT_TRUE(axis.wait_until_acknowledged(std::chrono::seconds(10)));
  hold = false;
  ASSERT_TRUE(wait_until([&] { return numbers.values().back() == 1201; }));
  EXPECT_EQ(numbers.values().size() + receiver.samples_lost(), 1201U);
  EXPECT_GT(receiver.samples_lost(), 0U);
  ASSERT_FALSE(problems.values().empty());
  EXPECT_THAT(problems.values().front(), HasSubstr("samples of test_rig/axis lost"));
}

TEST(Participant, SaysThatAPeerVanished) {
  const int domain = domain_of_this_test();
  Participant participant(loopback_participant("watcher", domain));
  Seen<std::string> problems;
  Seen<int> clouds;
  participant.on_problem([&](const std::string& problem) { problems.add(problem); });
  participant.subscribe<PointCloud2>(
      kRawCloudTopic, [&](const auto& cloud) { clouds.add(cloud.header().stamp().sec()); });
  participant.start();
  CloudSender sender(domain, 1);
  ASSERT_TRUE(wait_until([&] { return !clouds.values().empty(); }));
  sender.kill_at_once();
  ASSERT_TRUE(wait_until([&] { return !problems.values().empty(); }));
  EXPECT_THAT(problems.values().front(), HasSubstr("test_rig/cloud_sender vanished"));
}

TEST(Participant, SaysThatQosDoesNotMatch) {
  const int domain = domain_of_this_test();
  const std::string profiles = best_effort_profiles();
  Participant participant(loopback_participant("asks_for_more", domain));
  Seen<std::string> problems;
  participant.on_problem([&](const std::string& problem) { problems.add(problem); });
  participant.subscribe<PointCloud2>(kRawCloudTopic, [](const auto&) {});
  participant.start();
  CloudSender sender(domain, 1, profiles);
  ASSERT_TRUE(wait_until([&] { return !problems.values().empty(); }));
  EXPECT_THAT(problems.values().front(),
              AllOf(HasSubstr("rt/test_rig/raw_cloud"), HasSubstr("reliability")));
  sender.kill_at_once();  // it would wait for a reader
}

// Another's program on Fast DDS, which describes its types to everyone, as is the default there.
class DescribingReader {
 public:
  DescribingReader(int domain, const std::string& topic_name) {
    registerpoint_cloud2Types();
    factory()->load_XML_profiles_file(kProfiles);
    participant_ = factory()->create_participant_with_profile(static_cast<fast::DomainId_t>(domain),
                                                              "loopback");
    fast::TypeSupport type(new TypeSupportOf<PointCloud2>::Type());
    type.register_type(participant_);
    auto* const topic =
        participant_->create_topic(topic_name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
    reader_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
                  ->create_datareader_with_profile(topic, "raw_cloud");
    participant_->enable();
  }
  ~DescribingReader() {
    participant_->delete_contained_entities();
    factory()->delete_participant(participant_);
  }

  std::optional<PointCloud2> next() {
    PointCloud2 cloud;
    fast::SampleInfo info;
    if (!wait_until(
            [&] { return reader_->take_next_sample(&cloud, &info) == ReturnCode_t::RETCODE_OK; })) {
      return std::nullopt;
    }
    return cloud;
  }

 private:
  static fast::DomainParticipantFactory* factory() {
    return fast::DomainParticipantFactory::get_instance();
  }
  fast::DomainParticipant* participant_ = nullptr;
  fast::DataReader* reader_ = nullptr;
};

// Fast DDS 2.9 alone crashes: a cloud's fields are a sequence of structs.
TEST(Participant, OutlivesAPeerThatDescribesItsTypes) {
  const int domain = domain_of_this_test();
  DescribingReader reader(domain, "rt/test_rig/raw_cloud");
  CloudSender sender(domain, 1);
  const auto cloud = reader.next();
  ASSERT_TRUE(cloud.has_value()) << "the sender ended with " << sender.end();
  EXPECT_TRUE(*cloud == numbered_cloud(1));
  EXPECT_EQ(sender.end(), 0);
}

TEST(Participant, RunsCallbacksAndTicksOnOneThread) {
  const int domain = domain_of_this_test();
  Participant participant(loopback_participant("both", domain));
  Writer<msg::Axis> axis(participant, kAxisTopic);
  Seen<std::thread::id> threads;
  Seen<int> ticks;
  participant.subscribe<msg::Axis>(kAxisTopic,
                                   [&](const auto&) { threads.add(std::this_thread::get_id()); });
  participant.on_tick(std::chrono::milliseconds(5), [&] {
    threads.add(std::this_thread::get_id());
    ticks.add(1);
    axis.write(msg::Axis());  // writing from a callback is allowed
  });
  participant.start();
  ASSERT_TRUE(
      wait_until([&] { return ticks.values().size() > 20 && threads.values().size() > 30; }));
  participant.stop();
  for (const auto thread : threads.values()) EXPECT_EQ(thread, threads.values().front());
  EXPECT_NE(threads.values().front(), std::this_thread::get_id());
}

TEST(Participant, SaysWhatToDoWhenItCannotStart) {
  ParticipantOptions options = loopback_participant("nobody", domain_of_this_test());
  options.network = "carrier_pigeon";
  try {
    const Participant participant(options);
    FAIL() << "started";
  } catch (const DdsError& error) {
    EXPECT_THAT(error.what(), HasSubstr("carrier_pigeon"));
    EXPECT_THAT(error.what(), HasSubstr("--network"));
  }
}

}  // namespace
}  // namespace swivel
