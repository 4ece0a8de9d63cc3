// Who else is there: hears of other participants on Fast DDS's threads, where nothing else may be
// done, and keeps the news for ours.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <mutex>
#include <string>

namespace swivel {

class PeerListener : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  using Discovery = eprosima::fastrtps::rtps::ParticipantDiscoveryInfo;
  struct News {
    std::string name;
    Discovery::DISCOVERY_STATUS status;
  };

  // `woken` is triggered when there are news.
  explicit PeerListener(eprosima::fastdds::dds::GuardCondition& woken) : woken_(woken) {}

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant*,
                                Discovery&& info) override;
  void onParticipantAuthentication(
      eprosima::fastdds::dds::DomainParticipant*,
      eprosima::fastrtps::rtps::ParticipantAuthenticationInfo&& info) override;

  // Attempts of strangers that DDS Security turned away.
  std::uint64_t refusals() const { return refusals_; }

  std::deque<News> take_news();

  // Also of those that have left; empty if never seen.
  std::string name_of(const eprosima::fastrtps::rtps::GuidPrefix_t& peer) const;

 private:
  eprosima::fastdds::dds::GuardCondition& woken_;
  std::atomic<std::uint64_t> refusals_{0};
  mutable std::mutex mutex_;
  std::deque<News> news_;
  std::map<eprosima::fastrtps::rtps::GuidPrefix_t, std::string> names_;
};

}  // namespace swivel
