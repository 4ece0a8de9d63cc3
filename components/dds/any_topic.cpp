#include "components/dds/any_topic.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <typeinfo>
#include <utility>

namespace swivel {
namespace {

using eprosima::fastdds::dds::InstanceHandle_t;
using eprosima::fastdds::dds::SampleInfo;
using eprosima::fastdds::dds::TopicDataType;
using eprosima::fastdds::dds::TypeSupport;
using eprosima::fastrtps::rtps::SerializedPayload_t;

// Under the name of a type of ours, but its samples are std::strings that hold the CDR.
class CopiedType : public TopicDataType {
 public:
  explicit CopiedType(TypeSupport original) : original_(std::move(original)) {
    setName(original_->getName());
    m_typeSize = original_->m_typeSize;
    m_isGetKeyDefined = original_->m_isGetKeyDefined;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* sample, SerializedPayload_t* payload) override {
    const std::string& cdr = *static_cast<std::string*>(sample);
    if (cdr.size() < kHeadingSize || cdr.size() > payload->max_size) return false;
    std::memcpy(payload->data, cdr.data(), cdr.size());
    payload->length = static_cast<std::uint32_t>(cdr.size());
    payload->encapsulation = static_cast<std::uint8_t>(cdr[1]);
    return true;
  }

  bool deserialize(SerializedPayload_t* payload, void* sample) override {
    static_cast<std::string*>(sample)->assign(reinterpret_cast<const char*>(payload->data),
                                              payload->length);
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) override {
    return
        [sample] { return static_cast<std::uint32_t>(static_cast<std::string*>(sample)->size()); };
  }

  void* createData() override { return new std::string(); }
  void deleteData(void* sample) override { delete static_cast<std::string*>(sample); }

  // Asked for on writing, and on reading where the writer did not send it along.
  bool getKey(void* sample, InstanceHandle_t* key, bool force_md5) override {
    void* const message = original_->createData();
    const bool known = decode_cdr(*original_, *static_cast<std::string*>(sample), message) &&
                       original_->getKey(message, key, force_md5);
    original_->deleteData(message);
    return known;
  }

 private:
  static constexpr std::size_t kHeadingSize = 4;
  TypeSupport original_;
};

template <class Message>
AnyTopic any(const Topic<Message>& topic) {
  return {topic.name, topic.for_ros,
          [] { return make_type<Message>(std::make_shared<Refusals>()); }};
}

TypeSupport copied_type(const AnyTopic& topic) {
  return TypeSupport(new CopiedType(topic.make_type()));
}

std::int64_t in_ns(const eprosima::fastrtps::rtps::Time_t& time) {
  return std::int64_t{time.seconds()} * 1'000'000'000 + time.nanosec();
}

std::string in_words(const eprosima::fastrtps::rtps::GUID_t& writer) {
  std::ostringstream words;
  words << writer;
  return words.str();
}

}  // namespace

const std::vector<AnyTopic>& all_topics() {
  static const std::vector<AnyTopic> topics{any(kScanLineTopic),
                                            any(kAxisTopic),
                                            any(kSweepTopic),
                                            any(kSweepRequestTopic),
                                            any(kRawCloudTopic),
                                            any(kCloudTopic),
                                            any(kAttitudeTopic),
                                            any(kCalibrationTopic),
                                            any(kCalibrationRequestTopic),
                                            any(kCalibrationProgressTopic),
                                            any(kHealthTopic),
                                            any(kWireTopic)};
  return topics;
}

std::optional<RigTopic> find_topic(const std::string& full_name) {
  const std::size_t slash = full_name.rfind('/');
  if (slash == std::string::npos) return std::nullopt;
  for (const AnyTopic& topic : all_topics()) {
    const std::size_t rig_start = topic.for_ros ? std::strlen("rt/") : 0;
    if (slash <= rig_start) continue;
    std::string rig = full_name.substr(rig_start, slash - rig_start);
    if (topic.full_name(rig) == full_name) return RigTopic{topic, std::move(rig)};
  }
  return std::nullopt;
}

CdrWriter::CdrWriter(Participant& participant, const AnyTopic& topic)
    : AnyWriter(participant.make_writer(topic.full_name(participant.rig()), topic.name,
                                        copied_type(topic))) {}

bool CdrWriter::write(const std::string& cdr) {
  return writer_->write(const_cast<std::string*>(&cdr));
}

void Participant::subscribe_cdr(const AnyTopic& topic, std::function<void(CdrSample&&)> callback) {
  const std::string name = topic.full_name(options_.rig);
  auto* const reader = make_reader(name, topic.name, copied_type(topic));
  auto last_numbers = std::make_shared<std::map<InstanceHandle_t, std::uint64_t>>();
  watch(reader, name, true, [this, reader, name, last_numbers, callback = std::move(callback)] {
    CdrSample sample;
    SampleInfo info;
    while (!stopping_ && reader->take_next_sample(&sample.cdr, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      sample.number = info.sample_identity.sequence_number().to64long();
      sample.sent_time_ns = in_ns(info.source_timestamp);
      sample.writer = in_words(info.sample_identity.writer_guid());
      sample.participant = name_of_peer(info.sample_identity.writer_guid());
      count_gap(name, (*last_numbers)[info.publication_handle], sample.number);
      callback(std::move(sample));
      sample = {};
    }
  });
}

bool decode_cdr(TopicDataType& type, std::string_view cdr, void* message) {
  SerializedPayload_t payload;
  payload.data = reinterpret_cast<unsigned char*>(const_cast<char*>(cdr.data()));
  payload.length = payload.max_size = static_cast<std::uint32_t>(cdr.size());
  const bool decoded = type.deserialize(&payload, message);
  payload.data = nullptr;  // it is not the payload's own
  return decoded;
}

std::string encode_cdr(TopicDataType& type, const void* message) {
  void* const sample = const_cast<void*>(message);
  SerializedPayload_t payload(type.getSerializedSizeProvider(sample)());
  if (!type.serialize(sample, &payload)) return {};
  return std::string(reinterpret_cast<const char*>(payload.data), payload.length);
}

}  // namespace swivel
