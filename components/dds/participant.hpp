// The one wrapper round Fast DDS: a participant with typed writers and readers.
//
//   Participant participant({.name = "cloud_assembler", ...});
//   Writer<msg::Sweep> sweeps(participant, kSweepTopic);
//   participant.subscribe(kScanLineTopic, [&](const msg::ScanLine& line) { ... });
//   participant.start();
//
// Callbacks and ticks run one after the other on one thread of the participant, never in
// Fast DDS's own, so that what they share needs no lock and they may create or write what they
// like. QoS comes from config/dds_profiles.xml, a profile a topic.
#pragma once

#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "components/dds/topics.hpp"
#include "components/dds/wary_type.hpp"

namespace swivel {

// What config/dds_profiles.xml asks the kernel for, so that it holds the bursts that a cloud comes
// in.
inline constexpr int kUdpBufferBytes = 4 << 20;

struct ParticipantOptions {
  std::string name;           // "cloud_assembler"; what others see in their logs
  std::string rig;            // the first part of the topics' names
  int domain = 0;             // 0 .. 232
  std::string network;        // a participant profile: "loopback" or "lan"
  std::string profiles_path;  // dds_profiles.xml
  // For what it writes to others on this computer; all of it is resident. 0: as the profile says,
  // which is enough for clouds.
  std::uint32_t shared_memory_bytes = 0;
  // A.B.C.D[:PORT] of a discovery server, which says who is there. Empty: multicast does.
  std::string discovery_server = {};
  bool serves_discovery = false;  // it is that server
  // A.B.C.D of computers that are asked directly who is there, besides multicast.
  std::vector<std::string> peers = {};
  // The folder that `swivel keys` made, to talk with those alone who have keys of it. Empty: in the
  // clear, with everybody.
  std::string security_folder = {};
};

// No participant, writer or reader could be made; what() says what to do.
struct DdsError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A sample as it came over the wire, not decoded.
struct CdrSample {
  std::string cdr;           // with its heading of four bytes
  std::uint64_t number = 0;  // of its writer's samples, as DDS counts them
  std::int64_t sent_time_ns = 0;
  std::string writer;       // tells writers of one topic apart
  std::string participant;  // the writer's: "swivel/hokuyo_reader"
};

struct AnyTopic;
class PeerListener;

class Participant {
 public:
  // Throws DdsError.
  explicit Participant(const ParticipantOptions& options);
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  ~Participant();

  // Writers and subscriptions are made before start(), which makes the participant known to
  // others. Throws DdsError.
  template <class Message>
  void subscribe(const Topic<Message>& topic, std::function<void(const Message&)> callback);
  // Not together with a typed subscription or writer of the same type.
  void subscribe_cdr(const AnyTopic& topic, std::function<void(CdrSample&&)> callback);
  void on_tick(std::chrono::milliseconds period, std::function<void()> callback);
  // Told, in words, of unmatched QoS, lost samples, vanished peers and refused strangers. They are
  // logged anyhow.
  void on_problem(std::function<void(const std::string&)> callback);

  // Makes the participant known to others; its writers and subscriptions are made before. Throws
  // DdsError.
  void start();
  void stop();  // no callback runs after it returns; not from a callback

  const std::string& rig() const { return options_.rig; }
  const std::string& name() const { return options_.name; }
  // Samples that a writer sent and we did not get, over all topics.
  std::uint64_t samples_lost() const { return samples_lost_; }
  // Samples that came and are no message of their topic, or too large for one.
  std::uint64_t samples_refused() const { return refusals_->total(); }

 private:
  template <class Message>
  friend class Writer;
  friend class CdrWriter;
  struct Endpoint;

  eprosima::fastdds::dds::Topic* make_topic(const std::string& name,
                                            const eprosima::fastdds::dds::TypeSupport& type);
  eprosima::fastdds::dds::DataWriter* make_writer(const std::string& topic, const char* profile,
                                                  const eprosima::fastdds::dds::TypeSupport& type);
  eprosima::fastdds::dds::DataReader* make_reader(const std::string& topic, const char* profile,
                                                  const eprosima::fastdds::dds::TypeSupport& type);
  void watch(eprosima::fastdds::dds::DataReader* reader, const std::string& topic, bool numbered,
             std::function<void()> take);
  std::string name_of_peer(const eprosima::fastrtps::rtps::GUID_t& writer) const;
  void count_gap(const std::string& topic, std::uint64_t& last, std::uint64_t number);
  void warn(const std::string& problem);
  void run();
  void handle(Endpoint& endpoint);
  void handle_reader_status(Endpoint& endpoint);
  void handle_writer_status(Endpoint& endpoint);
  void report_peers();
  void report_refusals();
  void report_strangers();
  std::chrono::milliseconds run_ticks();

  ParticipantOptions options_;
  std::unique_ptr<PeerListener> peers_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  std::map<std::string, eprosima::fastdds::dds::Topic*> topics_;
  std::vector<std::unique_ptr<Endpoint>> endpoints_;
  struct Tick {
    std::chrono::milliseconds period;
    std::chrono::steady_clock::time_point due;
    std::function<void()> callback;
  };
  std::vector<Tick> ticks_;
  std::function<void(const std::string&)> on_problem_;
  std::atomic<std::uint64_t> samples_lost_{0};
  std::shared_ptr<Refusals> refusals_ = std::make_shared<Refusals>();
  std::uint64_t strangers_told_ = 0;
  std::chrono::steady_clock::time_point strangers_told_time_;
  eprosima::fastdds::dds::WaitSet wait_set_;
  eprosima::fastdds::dds::GuardCondition woken_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// The type without its description. Fast DDS 2.9 rebuilds a type that it hears described, and
// crashes where that is a sequence of structs it does not know: with it, a subscriber to one of
// our topics would be killed by our other topics.
template <class Message>
eprosima::fastdds::dds::TypeSupport make_type(std::shared_ptr<Refusals> refusals) {
  eprosima::fastdds::dds::TypeSupport type(new WaryType<Message>(std::move(refusals)));
  type->auto_fill_type_object(false);
  type->auto_fill_type_information(false);
  return type;
}

// What writers of every type have in common.
class AnyWriter {
 public:
  // Until every reader has what was written; false when the time is over.
  bool wait_until_acknowledged(std::chrono::milliseconds timeout);
  std::size_t reader_count() const;

 protected:
  explicit AnyWriter(eprosima::fastdds::dds::DataWriter* writer) : writer_(writer) {}
  eprosima::fastdds::dds::DataWriter* writer_;
};

// Writes from any thread. Must not outlive its participant.
template <class Message>
class Writer : public AnyWriter {
 public:
  Writer(Participant& participant, const swivel::Topic<Message>& topic)
      : AnyWriter(participant.make_writer(topic.full_name(participant.rig()), topic.name,
                                          make_type<Message>(participant.refusals_))),
        rig_(participant.rig()) {}

  // Fills rig and sequence number. False if it could not be sent within the topic's
  // max_blocking_time, and counted as such.
  bool write(Message& message) {
    const std::lock_guard lock(mutex_);
    stamp_message(message, rig_, next_number_);
    if (!writer_->write(&message)) {
      ++failures_;
      return false;
    }
    ++next_number_;
    return true;
  }
  bool write(Message&& message) { return write(message); }

  std::uint64_t written() const { return next_number_ - 1; }
  std::uint64_t failures() const { return failures_; }

 private:
  std::string rig_;
  std::mutex mutex_;
  std::atomic<std::uint64_t> next_number_{1};
  std::atomic<std::uint64_t> failures_{0};
};

template <class Message>
void Participant::subscribe(const swivel::Topic<Message>& topic,
                            std::function<void(const Message&)> callback) {
  using eprosima::fastdds::dds::SampleInfo;
  const std::string name = topic.full_name(options_.rig);
  auto* const reader = make_reader(name, topic.name, make_type<Message>(refusals_));
  // The message is kept from sample to sample: a cloud's 11 MB are allocated once.
  auto message = std::make_shared<Message>();
  auto last_numbers =
      std::make_shared<std::map<eprosima::fastdds::dds::InstanceHandle_t, std::uint64_t>>();
  watch(reader, name, is_numbered(*message),
        [this, reader, name, message, last_numbers, callback = std::move(callback)] {
          SampleInfo info;
          while (!stopping_ &&
                 reader->take_next_sample(message.get(), &info) == ReturnCode_t::RETCODE_OK) {
            if (!info.valid_data) continue;
            count_gap(name, (*last_numbers)[info.publication_handle], number_of(*message));
            callback(*message);
          }
        });
}

}  // namespace swivel
