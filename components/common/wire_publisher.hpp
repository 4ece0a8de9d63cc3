// Publishes what passes over a device's wire, to whoever listens; while nobody does, it only keeps
// how the connection began, since what follows makes little sense without it.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "components/dds/participant.hpp"
#include "hardware/io/wire_tap.hpp"

namespace swivel {

class WirePublisher {
 public:
  // Before participant.start().
  WirePublisher(Participant& participant, msg::WireDevice device);

  // For the session with the device, which must end before this does.
  WireTap tap();

  std::uint64_t not_sent() const { return writer_.failures(); }

 private:
  void take(const WireEvent& event);
  msg::WireBytes message_of(const WireEvent& event);
  void keep(const msg::WireBytes& message);
  void greet_new_listeners();

  const msg::WireDevice device_;
  Writer<msg::WireBytes> writer_;
  std::mutex mutex_;  // of what follows
  std::size_t listeners_ = 0;
  std::int64_t opened_time_ns_ = 0;
  std::uint64_t bytes_sent_ = 0;
  std::uint64_t bytes_received_ = 0;
  std::vector<msg::WireBytes> beginning_;
  std::size_t room_ = 0;  // left for it
};

}  // namespace swivel
