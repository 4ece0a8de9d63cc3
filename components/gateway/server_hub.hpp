// What the server's sessions share. All but the counters belongs to the server's thread. For
// server.cpp alone.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <set>
#include <utility>

#include "components/gateway/server.hpp"

namespace swivel {

class WebSocketSession;

constexpr std::size_t kMostConnections = 64;
constexpr std::size_t kMostClients = 16;
constexpr std::size_t kMostChannels = 16;

struct AtomicCounters {
  std::atomic<std::uint64_t> connections{0};
  std::atomic<std::uint64_t> connections_refused{0};
  std::atomic<std::uint64_t> requests_refused{0};
  std::atomic<std::uint64_t> requests_broken{0};
  std::atomic<std::uint64_t> messages_refused{0};
  std::atomic<std::uint64_t> frames_sent{0};
  std::atomic<std::uint64_t> frames_dropped{0};
  std::atomic<std::uint64_t> clients{0};
};

struct ServerHub {
  ServerContent content;
  AccessPolicy access;
  AtomicCounters counters;
  std::array<std::atomic<std::size_t>, kMostChannels> subscribers{};  // by channel
  std::set<WebSocketSession*> clients;
  std::size_t open_connections = 0;
};

// Counts a connection for as long as it is there.
class ConnectionTicket {
 public:
  explicit ConnectionTicket(ServerHub& hub) : hub_(&hub) { ++hub_->open_connections; }
  ConnectionTicket(ConnectionTicket&& other) noexcept : hub_(std::exchange(other.hub_, nullptr)) {}
  ConnectionTicket& operator=(ConnectionTicket&&) = delete;
  ~ConnectionTicket() {
    if (hub_ != nullptr) --hub_->open_connections;
  }

 private:
  ServerHub* hub_;
};

}  // namespace swivel
