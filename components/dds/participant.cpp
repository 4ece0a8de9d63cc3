#include "components/dds/participant.hpp"

#include <fastrtps/types/TypeObjectFactory.h>
#include <algorithm>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <typeinfo>

#include "components/dds/participant_qos.hpp"
#include "components/dds/peer_listener.hpp"
#include "components/log/log.hpp"

// Fast DDS 2.9 rebuilds every type that any peer describes, whether somebody wants to know or not,
// and crashes where that is a sequence of structs that it has not met: one foreign program would
// end all of ours. Nothing here discovers types. So this definition stands in for the library's,
// which calls it through the dynamic linker, and that takes the program's first.
namespace eprosima::fastrtps::types {
DynamicType_ptr TypeObjectFactory::build_dynamic_type(const std::string&, const TypeIdentifier*,
                                                      const TypeObject*) const {
  return DynamicType_ptr(nullptr);
}
}  // namespace eprosima::fastrtps::types

namespace swivel {

namespace fast = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::ParticipantDiscoveryInfo;

struct Participant::Endpoint {
  std::string topic;
  fast::DataReader* reader = nullptr;  // one of the two
  fast::DataWriter* writer = nullptr;
  std::function<void()> take;
  bool numbered = false;  // losses show as holes in the sequence numbers

  fast::Entity& entity() const {
    return reader != nullptr ? static_cast<fast::Entity&>(*reader) : *writer;
  }
};

namespace {

const char* policy_in_words(fast::QosPolicyId_t policy) {
  switch (policy) {
    case fast::DURABILITY_QOS_POLICY_ID:
      return "durability";
    case fast::DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case fast::OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case fast::LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case fast::RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case fast::DESTINATIONORDER_QOS_POLICY_ID:
      return "destination order";
    case fast::PARTITION_QOS_POLICY_ID:
      return "partition";
    case fast::DATAREPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    default:
      return "some quality of service";
  }
}

}  // namespace

Participant::Participant(const ParticipantOptions& options)
    : options_(options), peers_(std::make_unique<PeerListener>(woken_)) {
  auto* const factory = fast::DomainParticipantFactory::get_instance();
  // The participant comes to life in start(), with all it has: no peer is met half-made.
  fast::DomainParticipantFactoryQos factory_qos;
  factory->get_qos(factory_qos);
  factory_qos.entity_factory().autoenable_created_entities = false;
  factory->set_qos(factory_qos);
  const fast::DomainParticipantQos qos = participant_qos(options_);
  participant_ = factory->create_participant(static_cast<fast::DomainId_t>(options_.domain), qos,
                                             peers_.get(), fast::StatusMask::none());
  if (participant_ == nullptr) {
    throw DdsError("no DDS participant in domain " + std::to_string(options_.domain) +
                   " with network '" + options_.network +
                   "'; is the domain within 0 to 232, is /dev/shm writable?");
  }
  publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  wait_set_.attach_condition(woken_);
  warn_of_this_computer(options_, qos);
}

Participant::~Participant() {
  stop();
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

fast::Topic* Participant::make_topic(const std::string& name, const fast::TypeSupport& type) {
  // A type is registered once, and the first decides what its samples look like in memory.
  const fast::TypeSupport registered = participant_->find_type(type.get_type_name());
  if (!registered.empty()) {
    const fast::TopicDataType& before = *registered.get();
    const fast::TopicDataType& now = *type.get();
    if (typeid(before) != typeid(now)) {
      throw DdsError("topic " + name + ": " + type.get_type_name() + " is used typed and as CDR");
    }
  }
  if (const auto known = topics_.find(name); known != topics_.end()) return known->second;
  type.register_type(participant_);
  auto* const topic =
      participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  if (topic == nullptr) throw DdsError("topic " + name + " could not be made");
  return topics_[name] = topic;
}

fast::DataWriter* Participant::make_writer(const std::string& topic, const char* profile,
                                           const fast::TypeSupport& type) {
  auto* const writer = publisher_->create_datawriter_with_profile(make_topic(topic, type), profile);
  if (writer == nullptr) {
    throw DdsError("no writer for " + topic + "; has " + options_.profiles_path +
                   " a data_writer profile '" + profile + "'?");
  }
  auto endpoint = std::make_unique<Endpoint>();
  endpoint->topic = topic;
  endpoint->writer = writer;
  writer->get_statuscondition().set_enabled_statuses(fast::StatusMask::offered_incompatible_qos()
                                                     << fast::StatusMask::publication_matched());
  wait_set_.attach_condition(writer->get_statuscondition());
  endpoints_.push_back(std::move(endpoint));
  return writer;
}

fast::DataReader* Participant::make_reader(const std::string& topic, const char* profile,
                                           const fast::TypeSupport& type) {
  auto* const reader =
      subscriber_->create_datareader_with_profile(make_topic(topic, type), profile);
  if (reader == nullptr) {
    throw DdsError("no reader for " + topic + "; has " + options_.profiles_path +
                   " a data_reader profile '" + profile + "'?");
  }
  return reader;
}

void Participant::watch(fast::DataReader* reader, const std::string& topic, bool numbered,
                        std::function<void()> take) {
  auto endpoint = std::make_unique<Endpoint>();
  endpoint->topic = topic;
  endpoint->reader = reader;
  endpoint->take = std::move(take);
  endpoint->numbered = numbered;
  reader->get_statuscondition().set_enabled_statuses(
      fast::StatusMask::data_available()
      << fast::StatusMask::requested_incompatible_qos() << fast::StatusMask::subscription_matched()
      << fast::StatusMask::sample_lost());
  wait_set_.attach_condition(reader->get_statuscondition());
  endpoints_.push_back(std::move(endpoint));
}

void Participant::on_tick(std::chrono::milliseconds period, std::function<void()> callback) {
  ticks_.push_back({period, std::chrono::steady_clock::now() + period, std::move(callback)});
}

void Participant::on_problem(std::function<void(const std::string&)> callback) {
  on_problem_ = std::move(callback);
}

void Participant::start() {
  if (participant_->enable() != ReturnCode_t::RETCODE_OK) {
    if (options_.security_folder.empty())
      throw DdsError("the DDS participant could not be enabled; is /dev/shm full?");
    throw DdsError("the DDS participant could not be enabled with the keys in " +
                   options_.security_folder +
                   ": are they of one 'swivel keys', have they expired?");
  }
  thread_ = std::thread([this] { run(); });
}

void Participant::stop() {
  stopping_ = true;
  woken_.set_trigger_value(true);
  if (thread_.joinable()) thread_.join();
}

void Participant::run() {
  fast::ConditionSeq active;
  while (!stopping_) {
    const auto pause = run_ticks();
    const eprosima::fastrtps::Duration_t timeout(static_cast<long double>(pause.count()) * 1e-3L);
    wait_set_.wait(active, timeout);
    woken_.set_trigger_value(false);
    report_peers();
    report_strangers();
    for (const auto& endpoint : endpoints_) {
      if (stopping_) break;
      handle(*endpoint);
    }
    report_refusals();
  }
}

// Runs what is due; the time until the next is due.
std::chrono::milliseconds Participant::run_ticks() {
  auto pause = std::chrono::milliseconds(1000);
  for (Tick& tick : ticks_) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= tick.due) {
      tick.callback();
      tick.due = now + tick.period;
    }
    pause = std::min(pause, std::chrono::ceil<std::chrono::milliseconds>(tick.due - now));
  }
  return std::max(pause, std::chrono::milliseconds(1));
}

void Participant::handle(Endpoint& endpoint) {
  if (!endpoint.entity().get_statuscondition().get_trigger_value()) return;
  if (endpoint.reader == nullptr) return handle_writer_status(endpoint);
  handle_reader_status(endpoint);
  endpoint.take();
}

void Participant::handle_reader_status(Endpoint& endpoint) {
  const fast::StatusMask changes = endpoint.reader->get_status_changes();
  if (changes.is_active(fast::StatusMask::requested_incompatible_qos())) {
    fast::RequestedIncompatibleQosStatus status;
    endpoint.reader->get_requested_incompatible_qos_status(status);
    warn("a writer of " + endpoint.topic + " offers another " +
         policy_in_words(status.last_policy_id) + " than we ask for: we get nothing from it");
  }
  if (!endpoint.numbered && changes.is_active(fast::StatusMask::sample_lost())) {
    fast::SampleLostStatus status;
    endpoint.reader->get_sample_lost_status(status);
    samples_lost_ += static_cast<std::uint64_t>(std::max(status.total_count_change, 0));
    warn(std::to_string(status.total_count_change) + " samples of " + endpoint.topic + " lost");
  }
  if (changes.is_active(fast::StatusMask::subscription_matched())) {
    fast::SubscriptionMatchedStatus status;
    endpoint.reader->get_subscription_matched_status(status);
    log_debug("{}: {} writers", endpoint.topic, status.current_count);
  }
}

void Participant::handle_writer_status(Endpoint& endpoint) {
  const fast::StatusMask changes = endpoint.writer->get_status_changes();
  if (changes.is_active(fast::StatusMask::offered_incompatible_qos())) {
    fast::OfferedIncompatibleQosStatus status;
    endpoint.writer->get_offered_incompatible_qos_status(status);
    warn("a reader of " + endpoint.topic + " asks for another " +
         policy_in_words(status.last_policy_id) + " than we offer: it gets nothing");
  }
  if (changes.is_active(fast::StatusMask::publication_matched())) {
    fast::PublicationMatchedStatus status;
    endpoint.writer->get_publication_matched_status(status);
    log_debug("{}: {} readers", endpoint.topic, status.current_count);
  }
}

void Participant::report_peers() {
  for (const auto& news : peers_->take_news()) {
    if (news.status == ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT) {
      log_info("{} is here", news.name);
    } else if (news.status == ParticipantDiscoveryInfo::REMOVED_PARTICIPANT) {
      log_info("{} has left", news.name);
    } else if (news.status == ParticipantDiscoveryInfo::DROPPED_PARTICIPANT) {
      warn(news.name + " vanished: no sign of life for 5 s; did it crash, is the network down?");
    }
  }
}

void Participant::report_refusals() {
  for (const auto& [type, count] : refusals_->take_news()) {
    warn(std::to_string(count) + " samples refused: they are no " + type + ", or too large");
  }
}

// One line now and then: a stranger must not fill the log.
void Participant::report_strangers() {
  constexpr auto kSeldom = std::chrono::seconds(10);
  const std::uint64_t strangers = peers_->refusals();
  const auto now = std::chrono::steady_clock::now();
  if (strangers == strangers_told_ || now < strangers_told_time_ + kSeldom) return;
  strangers_told_ = strangers;
  strangers_told_time_ = now;
  warn("a stranger was refused, " + std::to_string(strangers) +
       " attempts so far: no certificate of our authority, or one that has expired");
}

std::string Participant::name_of_peer(const eprosima::fastrtps::rtps::GUID_t& writer) const {
  return peers_->name_of(writer.guidPrefix);
}

void Participant::count_gap(const std::string& topic, std::uint64_t& last, std::uint64_t number) {
  if (last != 0 && number > last + 1) {
    const std::uint64_t missing = number - last - 1;
    samples_lost_ += missing;
    warn(std::to_string(missing) + " samples of " + topic + " lost");
  }
  if (number != 0) last = number;
}

void Participant::warn(const std::string& problem) {
  log_warning("{}", problem);
  if (on_problem_) on_problem_(problem);
}

bool AnyWriter::wait_until_acknowledged(std::chrono::milliseconds timeout) {
  const auto milliseconds = timeout.count();
  return writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t(
             static_cast<std::int32_t>(milliseconds / 1000),
             static_cast<std::uint32_t>(milliseconds % 1000) * 1000000U)) ==
         ReturnCode_t::RETCODE_OK;
}

std::size_t AnyWriter::reader_count() const {
  fast::PublicationMatchedStatus status;
  writer_->get_publication_matched_status(status);
  return static_cast<std::size_t>(status.current_count);
}

}  // namespace swivel
