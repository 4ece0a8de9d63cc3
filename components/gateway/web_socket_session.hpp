// One client on a WebSocket: a page, or a program that speaks Foxglove. For server.cpp alone.
#pragma once

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>

#include "components/gateway/outbox.hpp"
#include "components/gateway/server_hub.hpp"

namespace swivel {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

constexpr std::size_t kMostWaitingBytes = 16U << 20;  // a cloud for Foxglove and something more
constexpr std::size_t kMostMessageBytes = 16U << 10;  // of a client
constexpr std::size_t kFragmentBytes = 64U << 10;     // between two of them a ping fits
constexpr auto kHandshakeTime = std::chrono::seconds(10);
constexpr auto kSilentTime = std::chrono::seconds(30);  // without even a pong

class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(boost::beast::tcp_stream&& stream, ConnectionTicket&& ticket, ServerHub& hub)
      : socket_(std::move(stream)), ticket_(std::move(ticket)), hub_(hub) {}

  ~WebSocketSession() {
    if (hub_.clients.erase(this) > 0) count_subscribers();
  }

  void start(const HttpRequest& request, const std::string& sub_protocol) {
    namespace websocket = boost::beast::websocket;
    if (is_foxglove(sub_protocol)) foxglove_.emplace(hub_.content.channels.size());
    socket_.set_option(websocket::stream_base::timeout{kHandshakeTime, kSilentTime, true});
    socket_.set_option(
        websocket::stream_base::decorator([sub_protocol](websocket::response_type& response) {
          response.set(boost::beast::http::field::sec_websocket_protocol, sub_protocol);
        }));
    socket_.read_message_max(kMostMessageBytes);
    socket_.write_buffer_bytes(kFragmentBytes);
    socket_.async_accept(request, [self = shared_from_this()](boost::beast::error_code error) {
      if (!error) return self->greet();
      ++self->hub_.counters.requests_broken;
    });
  }

  void send(Frame frame) {
    hub_.counters.frames_dropped += outbox_.push(std::move(frame));
    if (!going_out_) send_next();
  }

  void send(std::uint32_t channel, std::int64_t time_ns,
            const std::shared_ptr<const std::string>& message) {
    if (!foxglove_) return;
    for (const std::uint32_t subscription : foxglove_->to(channel))
      send({false, foxglove_message_head(subscription, time_ns), message});
  }

  bool is_page() const { return !foxglove_; }

 private:
  void greet() {
    hub_.clients.insert(this);
    hub_.counters.clients = hub_.clients.size();
    if (foxglove_) {
      for (std::string& text : foxglove_greeting(hub_.content.name, hub_.content.channels))
        send(text_frame(std::move(text)));
    } else {
      tell_all();
    }
    receive();
  }

  void tell_all() {
    for (Frame& frame : hub_.content.whole_state()) send(std::move(frame));
  }

  void receive() {
    incoming_.clear();
    socket_.async_read(incoming_,
                       [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
                         if (error == boost::beast::websocket::error::message_too_big)
                           ++self->hub_.counters.messages_refused;
                         if (error) return;
                         self->take(boost::beast::buffers_to_string(self->incoming_.data()));
                         self->receive();
                       });
  }

  void take(const std::string& message) {
    if (socket_.got_binary()) {
      ++hub_.counters.messages_refused;
    } else if (foxglove_) {
      const std::string problem = foxglove_->take(message);
      if (!problem.empty()) ++hub_.counters.messages_refused;
      if (!problem.empty()) send(text_frame(problem));
      count_subscribers();
    } else {
      hub_.content.page_command(message);
    }
  }

  void send_next() {
    going_out_ = outbox_.pop();
    if (!going_out_ && is_page() && outbox_.take_lag()) return tell_all();
    if (!going_out_) return;
    using boost::asio::buffer;
    const std::array<boost::asio::const_buffer, 2> parts{
        buffer(going_out_->head),
        going_out_->body ? buffer(*going_out_->body) : boost::asio::const_buffer()};
    socket_.text(going_out_->text);
    socket_.async_write(parts,
                        [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
                          self->going_out_.reset();
                          if (error) return;
                          ++self->hub_.counters.frames_sent;
                          self->send_next();
                        });
  }

  void count_subscribers() {
    hub_.counters.clients = hub_.clients.size();
    for (std::uint32_t channel = 0; channel < hub_.content.channels.size(); ++channel) {
      hub_.subscribers[channel] = static_cast<std::size_t>(
          std::count_if(hub_.clients.begin(), hub_.clients.end(), [&](const auto* client) {
            return client->foxglove_ && !client->foxglove_->to(channel).empty();
          }));
    }
  }

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  ConnectionTicket ticket_;
  ServerHub& hub_;
  std::optional<FoxgloveSubscriptions> foxglove_;
  Outbox outbox_{kMostWaitingBytes};
  std::optional<Frame> going_out_;
  boost::beast::flat_buffer incoming_;
};

}  // namespace swivel
