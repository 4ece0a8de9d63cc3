#include "components/common/wire_publisher.hpp"

namespace swivel {
namespace {

// The lidar's identity, its clock, and a second of scans; the stepper's settings, homing and some
// sweeps.
constexpr std::size_t kBeginningBytes = 256 << 10;

msg::WireKind kind_of(WireEvent::Kind kind) {
  switch (kind) {
    case WireEvent::Kind::kOpened:
      return msg::WIRE_OPENED;
    case WireEvent::Kind::kSent:
      return msg::WIRE_TO_DEVICE;
    case WireEvent::Kind::kReceived:
      return msg::WIRE_FROM_DEVICE;
    case WireEvent::Kind::kHungUp:
      return msg::WIRE_HUNG_UP;
    case WireEvent::Kind::kClosed:
      break;
  }
  return msg::WIRE_CLOSED;
}

}  // namespace

WirePublisher::WirePublisher(Participant& participant, msg::WireDevice device)
    : device_(device), writer_(participant, kWireTopic) {
  // A stepper at rest may be silent for long.
  participant.on_tick(std::chrono::milliseconds(200), [this] {
    const std::lock_guard lock(mutex_);
    greet_new_listeners();
  });
}

WireTap WirePublisher::tap() {
  return [this](const WireEvent& event) { take(event); };
}

void WirePublisher::take(const WireEvent& event) {
  const std::lock_guard lock(mutex_);
  greet_new_listeners();
  msg::WireBytes message = message_of(event);
  keep(message);
  if (listeners_ > 0) writer_.write(message);
}

msg::WireBytes WirePublisher::message_of(const WireEvent& event) {
  if (event.kind == WireEvent::Kind::kOpened) {
    opened_time_ns_ = event.time_ns;
    bytes_sent_ = bytes_received_ = 0;
  }
  const bool received = event.kind == WireEvent::Kind::kReceived;
  std::uint64_t& passed = received ? bytes_received_ : bytes_sent_;
  msg::WireBytes message;
  message.device(device_);
  message.kind(kind_of(event.kind));
  message.time_ns(event.time_ns);
  message.opened_time_ns(opened_time_ns_);
  message.offset(passed);
  message.bytes().assign(event.bytes.begin(), event.bytes.end());
  passed += event.bytes.size();
  return message;
}

void WirePublisher::keep(const msg::WireBytes& message) {
  if (message.kind() == msg::WIRE_OPENED) {
    beginning_.clear();
    room_ = kBeginningBytes;
  }
  const std::size_t size = message.bytes().size() + sizeof(message);
  // What is left out makes a hole; after it nothing more is kept.
  room_ = size <= room_ ? room_ - size : 0;
  if (room_ > 0) beginning_.push_back(message);
}

// Another listener hears it twice, and can tell by the offsets.
void WirePublisher::greet_new_listeners() {
  const std::size_t listeners = writer_.reader_count();
  if (listeners > listeners_) {
    for (msg::WireBytes& message : beginning_) writer_.write(message);
  }
  listeners_ = listeners;
}

}  // namespace swivel
