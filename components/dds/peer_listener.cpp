#include "components/dds/peer_listener.hpp"

#include <utility>

namespace swivel {

using eprosima::fastdds::dds::DomainParticipant;
using eprosima::fastrtps::rtps::ParticipantAuthenticationInfo;

void PeerListener::on_participant_discovery(DomainParticipant*, Discovery&& info) {
  {
    const std::lock_guard lock(mutex_);
    std::string name = info.info.m_participantName.c_str();
    if (name.empty()) name = "a participant without a name";  // other vendors send none
    names_[info.info.m_guid.guidPrefix] = name;
    news_.push_back({std::move(name), info.status});
  }
  woken_.set_trigger_value(true);
}

// Told of each attempt anew: who is refused tries again and again.
void PeerListener::onParticipantAuthentication(DomainParticipant*,
                                               ParticipantAuthenticationInfo&& info) {
  if (info.status != ParticipantAuthenticationInfo::UNAUTHORIZED_PARTICIPANT) return;
  ++refusals_;
  woken_.set_trigger_value(true);
}

std::deque<PeerListener::News> PeerListener::take_news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

std::string PeerListener::name_of(const eprosima::fastrtps::rtps::GuidPrefix_t& peer) const {
  const std::lock_guard lock(mutex_);
  const auto name = names_.find(peer);
  return name == names_.end() ? "" : name->second;
}

}  // namespace swivel
