// The one file that compiles Boost.Beast, which takes a minute.
#include "components/gateway/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <thread>

#include "components/gateway/http_session.hpp"
#include "components/log/log.hpp"

namespace swivel {
namespace {

using boost::asio::ip::tcp;

constexpr int kPortsTried = 100;
constexpr auto kPauseAfterError = std::chrono::milliseconds(100);

boost::asio::ip::address parsed_address(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  if (error) throw ServerError("'" + text + "' is no IP address to listen on");
  return address;
}

}  // namespace

std::optional<bool> is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return error ? std::nullopt : std::optional(parsed.is_loopback());
}

class Server::Implementation {
 public:
  Implementation(const ServerOptions& options, ServerContent content) : acceptor_(context_) {
    hub_.content = std::move(content);
    hub_.access = options.access;
    if (hub_.content.channels.size() > kMostChannels) throw ServerError("too many channels");
    listen({parsed_address(options.address), options.port});
    accept();
    thread_ = std::thread([this] { run(); });
  }

  ~Implementation() {
    context_.stop();
    thread_.join();
  }

  ServerHub& hub() { return hub_; }
  boost::asio::io_context& context() { return context_; }
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void listen(const tcp::endpoint& endpoint) {
    boost::system::error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    if (!error) return;
    const bool taken = error == boost::asio::error::address_in_use;
    throw ServerError("cannot listen on " + endpoint.address().to_string() + " port " +
                      std::to_string(endpoint.port()) + ": " +
                      (taken ? "it is taken, perhaps by the view of another rig; "
                             : error.message() + "; give another with ") +
                      "--port " + (taken ? free_port_after(endpoint) : ""));
  }

  // So that the user need not try them one after the other.
  std::string free_port_after(tcp::endpoint endpoint) {
    for (int more = 0; more < kPortsTried && endpoint.port() < UINT16_MAX; ++more) {
      endpoint.port(static_cast<std::uint16_t>(endpoint.port() + 1));
      boost::system::error_code error;
      tcp::acceptor trial(context_);
      trial.open(endpoint.protocol(), error);
      if (!error) trial.set_option(tcp::acceptor::reuse_address(true), error);
      if (!error) trial.bind(endpoint, error);
      if (!error) return std::to_string(endpoint.port()) + " is free";
    }
    return "0 takes any that is free";
  }

  void accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error) return accept_later();
      accept();  // first: whatever becomes of this one, there will be others
      ++hub_.counters.connections;
      if (hub_.open_connections < kMostConnections) {
        std::make_shared<HttpSession>(std::move(socket), hub_)->start();
      } else {
        ++hub_.counters.connections_refused;
      }
    });
  }

  // Out of file descriptors, say: that passes.
  void accept_later() {
    pause_.expires_after(kPauseAfterError);
    pause_.async_wait([this](boost::system::error_code) { accept(); });
  }

  void run() {
    while (!context_.stopped()) {
      try {
        context_.run();
      } catch (const std::exception& error) {
        log_error("one request or client failed: {}", error.what());
      }
    }
  }

  ServerHub hub_;  // outlives the sessions, which the context's handlers hold
  boost::asio::io_context context_{1};
  tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_{context_};
  std::thread thread_;
};

Server::Server(const ServerOptions& options, ServerContent content)
    : implementation_(std::make_unique<Implementation>(options, std::move(content))) {}

Server::~Server() = default;

std::uint16_t Server::port() const {
  return implementation_->port();
}

ServerCounters Server::counters() const {
  const AtomicCounters& counters = implementation_->hub().counters;
  return {counters.clients,          counters.connections,     counters.connections_refused,
          counters.requests_refused, counters.requests_broken, counters.messages_refused,
          counters.frames_sent,      counters.frames_dropped};
}

void Server::publish(Frame frame) {
  boost::asio::post(implementation_->context(), [this, frame = std::move(frame)] {
    for (WebSocketSession* client : implementation_->hub().clients)
      if (client->is_page()) client->send(frame);
  });
}

bool Server::wanted(std::uint32_t channel) const {
  return implementation_->hub().subscribers.at(channel) > 0;
}

void Server::publish(std::uint32_t channel, std::int64_t time_ns, std::string message) {
  auto shared = std::make_shared<const std::string>(std::move(message));
  boost::asio::post(implementation_->context(), [this, channel, time_ns, shared] {
    for (WebSocketSession* client : implementation_->hub().clients)
      client->send(channel, time_ns, shared);
  });
}

}  // namespace swivel
