// A writer of another's making may send any bytes on any topic.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <mutex>

#include "components/dds/any_topic.hpp"
#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

namespace fast = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using ::testing::Contains;
using ::testing::HasSubstr;

// Bears the name of a type of ours, and sends strings as they are.
class Bytes : public fast::TopicDataType {
 public:
  Bytes(const std::string& name, bool keyed) {
    setName(name.c_str());
    m_typeSize = 1 << 16;
    m_isGetKeyDefined = keyed;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* sample, SerializedPayload_t* payload) override {
    const std::string& bytes = *static_cast<std::string*>(sample);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(SerializedPayload_t*, void*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) override {
    return
        [sample] { return static_cast<std::uint32_t>(static_cast<std::string*>(sample)->size()); };
  }
  void* createData() override { return new std::string(); }
  void deleteData(void* sample) override { delete static_cast<std::string*>(sample); }
  bool getKey(void*, InstanceHandle_t* key, bool) override {
    key->value[0] = 1;
    return true;
  }
};

class HostileWriter {
 public:
  template <class Message>
  HostileWriter(int domain, const Topic<Message>& topic) {
    // ours, as a first participant of this process, has loaded the profiles
    participant_ = factory()->create_participant_with_profile(static_cast<fast::DomainId_t>(domain),
                                                              "loopback");
    typename TypeSupportOf<Message>::Type ours;
    fast::TypeSupport type(new Bytes(ours.getName(), ours.m_isGetKeyDefined));
    type.register_type(participant_);
    auto* const known = participant_->create_topic(topic.full_name("test_rig"),
                                                   type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
    writer_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                  ->create_datawriter_with_profile(known, topic.name);
    participant_->enable();
  }
  ~HostileWriter() {
    participant_->delete_contained_entities();
    factory()->delete_participant(participant_);
  }
  HostileWriter(const HostileWriter&) = delete;
  HostileWriter& operator=(const HostileWriter&) = delete;

  void send(std::string bytes) { EXPECT_TRUE(writer_->write(&bytes)); }

 private:
  static fast::DomainParticipantFactory* factory() {
    return fast::DomainParticipantFactory::get_instance();
  }
  fast::DomainParticipant* participant_;
  fast::DataWriter* writer_;
};

// A participant that counts what reaches its callback, and the hostile messages that do not.
template <class Message>
void expect_refused(const Topic<Message>& topic, const std::vector<std::string>& hostile,
                    const Message& sound) {
  const int domain = domain_of_this_test();
  Participant receiver(loopback_participant("receiver", domain));
  std::atomic<int> taken{0};
  std::mutex mutex;
  std::vector<std::string> problems;
  receiver.on_problem([&](const std::string& problem) {
    const std::lock_guard lock(mutex);
    problems.push_back(problem);
  });
  receiver.subscribe<Message>(topic, [&](const Message&) { ++taken; });
  receiver.start();
  HostileWriter writer(domain, topic);
  writer.send(encode_cdr(sound));
  ASSERT_TRUE(wait_until([&] { return taken == 1; }));
  for (std::size_t sent = 0; sent < hostile.size(); ++sent) {  // one by one: histories are short
    writer.send(hostile[sent]);
    ASSERT_TRUE(wait_until([&] { return receiver.samples_refused() == sent + 1; })) << sent;
  }
  writer.send(encode_cdr(sound));
  ASSERT_TRUE(wait_until([&] { return taken == 2; }));
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard lock(mutex);
    return !problems.empty();
  }));
  receiver.stop();
  EXPECT_THAT(problems, Contains(HasSubstr("samples refused")));
}

std::string with(std::string cdr, std::size_t position, const std::string& bytes) {
  return cdr.replace(position, bytes.size(), bytes);
}

// Every beginning of it, but for those after which all that is missing is taken for zeros.
std::vector<std::string> cut(const std::string& cdr) {
  std::vector<std::string> cuts;
  for (std::size_t size = 5; size + 8 < cdr.size(); size += 13) cuts.push_back(cdr.substr(0, size));
  return cuts;
}

const std::string kAllOnes(4, '\xff');

// `complete` stands as a byte before the last word, `reason`.
TEST(HostileWriter, ASweepThatIsNeitherCompleteNorNot) {
  const std::string sound = encode_cdr(msg::Sweep());
  std::vector<std::string> hostile = cut(sound);
  for (std::size_t at = sound.size() - 16; at < sound.size(); ++at) {
    const std::string changed = with(sound, at, "\x07");
    if (!decode_cdr<msg::Sweep>(changed)) hostile.push_back(changed);
  }
  hostile.push_back(with(sound, 0, "\x07\x07"));  // no heading of CDR
  EXPECT_GT(hostile.size(), 5U);
  expect_refused(kSweepTopic, hostile, msg::Sweep());
}

TEST(HostileWriter, LinesThatClaimMoreBeamsThanTheyHave) {
  msg::ScanLine line;
  line.ranges_mm(std::vector<std::uint16_t>(100, 1000));
  const std::string sound = encode_cdr(line);
  const std::size_t count_at = sound.find(std::string("\x64\0\0\0", 4));
  ASSERT_NE(count_at, std::string::npos);
  std::vector<std::string> hostile = cut(sound);
  hostile.push_back(with(sound, count_at, kAllOnes));
  hostile.push_back(sound + std::string(2 << 20, 'x'));
  expect_refused(kScanLineTopic, hostile, line);
}

// A million fields of 48 bytes in a megabyte; claimed by as few bytes as a sequence may hold.
TEST(HostileWriter, CloudsOfAMillionFieldsAreNotMadeRoomFor) {
  const std::string sound = encode_cdr(PointCloud2());
  // sec, nanosec, an empty frame (its length and a zero), height, width, then the fields' count
  const std::size_t count_at = 4 + 4 + 4 + 4 + 4 + 4 + 4;
  std::string many = with(sound, count_at, std::string("\0\0\x10\0", 4));
  many.resize(count_at + 4 + (1 << 20), '\x01');
  expect_refused(kRawCloudTopic, {sound.substr(0, 20)}, PointCloud2());  // DDS's own memory
  rusage before{};
  getrusage(RUSAGE_SELF, &before);
  expect_refused(kRawCloudTopic, {many, with(sound, count_at, kAllOnes), sound.substr(0, 20)},
                 PointCloud2());
  rusage after{};
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 40 * 1024) << "kB";
}

}  // namespace
}  // namespace swivel
