// The gateway's one port: the page, /metrics and /healthz over HTTP, and over WebSocket the page's
// own frames and the Foxglove protocol. One thread of its own. Boost.Beast stays behind it.
//
// Any client may do anything: requests, messages, clients and what waits for each are bounded;
// what is refused or dropped is counted.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/gateway/access_policy.hpp"
#include "components/gateway/foxglove.hpp"
#include "components/gateway/frame.hpp"

namespace swivel {

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8750;  // 0: any that is free
  AccessPolicy access;
};

// What the server asks of the gateway, on the server's thread.
struct ServerContent {
  std::string page;
  std::string name;  // told to Foxglove
  std::vector<FoxgloveChannel> channels;
  std::function<std::string()> metrics;
  std::function<bool()> healthy;
  std::function<std::vector<Frame>()> whole_state;            // for a page that comes late
  std::function<void(const std::string& text)> page_command;  // what a page sent
};

struct ServerCounters {
  std::uint64_t clients = 0;  // WebSockets open now
  std::uint64_t connections = 0;
  std::uint64_t connections_refused = 0;  // too many at once
  std::uint64_t requests_refused = 0;     // by the access policy
  std::uint64_t requests_broken = 0;      // malformed, too large, too slow, not for us
  std::uint64_t messages_refused = 0;     // from clients: too large, or not understood
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_dropped = 0;  // for clients that did not keep up
};

// The port cannot be had; what() says what to do.
struct ServerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Whether only this computer can reach it; none for what is no IP address.
std::optional<bool> is_loopback(const std::string& address);

class Server {
 public:
  // Listens and serves from here on. Throws ServerError.
  Server(const ServerOptions& options, ServerContent content);
  ~Server();  // closes all
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  ServerCounters counters() const;

  // From any thread.
  void publish(Frame frame);  // to every page
  bool wanted(std::uint32_t channel) const;
  void publish(std::uint32_t channel, std::int64_t time_ns, std::string message);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace swivel
