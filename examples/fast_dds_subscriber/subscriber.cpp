// Prints every scan line and every corrected cloud of a rig named swivel, and what it missed; ends
// after CLOUDS clouds. Swivel's installed package is all that it needs.
//   fast_dds_subscriber CLOUDS [DOMAIN]
#include <swivel/idl/point_cloud2PubSubTypes.h>
#include <swivel/idl/swivelPubSubTypes.h>

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <vector>

namespace {

namespace fast = eprosima::fastdds::dds;
using Cloud = sensor_msgs::msg::dds_::PointCloud2_;
using swivel::msg::ScanLine;

constexpr std::uint32_t kChecksumStart = 2166136261U;

// FNV-1a.
template <class Number>
std::uint32_t checksum(const std::vector<Number>& numbers, std::uint32_t sum = kChecksumStart) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(numbers.data());
  for (std::size_t i = 0; i < numbers.size() * sizeof(Number); ++i) {
    sum = (sum ^ bytes[i]) * 16777619U;
  }
  return sum;
}

// For Ctrl-C the system ends the program; nothing here needs more.
class Listening {
 public:
  explicit Listening(int domain) {
    auto* const factory = fast::DomainParticipantFactory::get_instance();
    if (factory->load_XML_profiles_file(SWIVEL_PROFILES) != ReturnCode_t::RETCODE_OK) return;
    participant_ = factory->create_participant_with_profile(domain, "loopback");
    if (participant_ == nullptr) return;
    subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    lines_ = reader<swivel::msg::ScanLinePubSubType>("swivel/scan_line", "scan_line");
    clouds_ = reader<sensor_msgs::msg::dds_::PointCloud2_PubSubType>("rt/swivel/cloud", "cloud");
  }
  ~Listening() {
    if (participant_ == nullptr) return;
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  bool started() const { return lines_ != nullptr && clouds_ != nullptr; }

  void until(int wanted) {
    fast::ConditionSeq active;
    while (clouds_taken_ < wanted) {
      wait_set_.wait(active, eprosima::fastrtps::c_TimeInfinite);
      // Clouds first: what was sent before the last cloud is then among the lines.
      take_clouds(wanted);
      take_lines();
    }
    std::printf("%" PRIu64 " scan lines, %" PRIu64 " missing; %d clouds\n", lines_taken_,
                lines_missing_, clouds_taken_);
  }

 private:
  // QoS is that of the profile of this name in Swivel's own dds_profiles.xml.
  template <class PubSubType>
  fast::DataReader* reader(const char* topic_name, const char* profile) {
    fast::TypeSupport type(new PubSubType());
    // Other programs on Fast DDS 2.9 can crash when they hear a type described.
    type->auto_fill_type_object(false);
    type->auto_fill_type_information(false);
    type.register_type(participant_);
    auto* const topic =
        participant_->create_topic(topic_name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
    auto* const reader = subscriber_->create_datareader_with_profile(topic, profile);
    if (reader == nullptr) return nullptr;
    reader->get_statuscondition().set_enabled_statuses(fast::StatusMask::data_available());
    wait_set_.attach_condition(reader->get_statuscondition());
    return reader;
  }

  void take_lines() {
    ScanLine line;
    fast::SampleInfo info;
    while (lines_->take_next_sample(&line, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      // Numbers run from 1 and start anew with the reader's process: a hole is a loss.
      const std::uint64_t number = line.sequence_number();
      if (last_number_ != 0 && number > last_number_) lines_missing_ += number - last_number_ - 1;
      last_number_ = number;
      ++lines_taken_;
      std::printf("scan_line %" PRIu64 " at %" PRId64 ": %zu ranges, %zu intensities, %08x\n",
                  number, line.beam0_time_ns(), line.ranges_mm().size(), line.intensities().size(),
                  checksum(line.intensities(), checksum(line.ranges_mm())));
    }
  }

  void take_clouds(int wanted) {
    Cloud cloud;
    fast::SampleInfo info;
    while (clouds_taken_ < wanted &&
           clouds_->take_next_sample(&cloud, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      ++clouds_taken_;
      std::printf("cloud of %d.%09u in %s: %u x %u, %zu bytes, %08x\n",
                  cloud.header().stamp().sec(), cloud.header().stamp().nanosec(),
                  cloud.header().frame_id().c_str(), cloud.height(), cloud.width(),
                  cloud.data().size(), checksum(cloud.data()));
    }
  }

  fast::DomainParticipant* participant_ = nullptr;
  fast::Subscriber* subscriber_ = nullptr;
  fast::WaitSet wait_set_;
  fast::DataReader* lines_ = nullptr;
  fast::DataReader* clouds_ = nullptr;
  std::uint64_t last_number_ = 0;
  std::uint64_t lines_taken_ = 0;
  std::uint64_t lines_missing_ = 0;
  int clouds_taken_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: fast_dds_subscriber CLOUDS [DOMAIN]\n");
    return 64;
  }
  Listening listening(argc == 3 ? std::atoi(argv[2]) : 0);
  if (!listening.started()) {
    std::fprintf(stderr, "no DDS participant with the profiles of %s\n", SWIVEL_PROFILES);
    return 69;
  }
  listening.until(std::atoi(argv[1]));
  return 0;
}
