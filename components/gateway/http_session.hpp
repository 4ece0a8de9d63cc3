// One HTTP request and its answer; a WebSocket's handshake goes on from here. For server.cpp
// alone.
#pragma once

#include "components/gateway/web_socket_session.hpp"

namespace swivel {

constexpr std::uint32_t kMostRequestBytes = 8U << 10;
constexpr auto kRequestTime = std::chrono::seconds(10);
constexpr const char* kPageProtocol = "swivel.view.v1";

// The page may load nothing from elsewhere, and nobody may put a frame round its buttons.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'";

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket&& socket, ServerHub& hub)
      : stream_(std::move(socket)), ticket_(hub), hub_(hub) {
    parser_.header_limit(kMostRequestBytes);
  }

  void start() {
    stream_.expires_after(kRequestTime);
    boost::beast::http::async_read(
        stream_, buffer_, parser_,
        [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
          // A browser opens connections ahead, and never uses some of them.
          const bool unused = error == boost::beast::http::error::end_of_stream;
          if (error && !unused) ++self->hub_.counters.requests_broken;
          if (!error) self->handle();
        });
  }

 private:
  void handle() {
    const HttpRequest& request = parser_.get();
    const std::string target(request.target());
    const AccessClaims claims{header(Field::host), header(Field::origin),
                              token_in(target, header(Field::authorization))};
    if (const auto refused = refusal(hub_.access, claims)) {
      ++hub_.counters.requests_refused;
      return answer(refused->status, "text/plain", refused->reason + "\n");
    }
    if (boost::beast::websocket::is_upgrade(request)) return upgrade();
    if (request.method() != boost::beast::http::verb::get) {
      ++hub_.counters.requests_broken;
      return answer(405, "text/plain", "only GET is answered here\n");
    }
    answer_get(target.substr(0, target.find('?')));
  }

  void answer_get(const std::string& path) {
    const ServerContent& content = hub_.content;
    if (path == "/") return answer(200, "text/html; charset=utf-8", content.page);
    if (path == "/metrics")
      return answer(200, "text/plain; version=0.0.4; charset=utf-8", content.metrics());
    if (path == "/healthz") {
      const bool healthy = content.healthy();
      return answer(healthy ? 200 : 503, "text/plain", healthy ? "ok\n" : "DDS does not answer\n");
    }
    answer(404, "text/plain", "here are: / /metrics /healthz\n");
  }

  void upgrade() {
    const std::string sub_protocol = known_sub_protocol();
    if (sub_protocol.empty()) {
      ++hub_.counters.requests_broken;
      return answer(400, "text/plain", "no sub-protocol that is known here\n");
    }
    if (hub_.clients.size() >= kMostClients) {
      ++hub_.counters.connections_refused;
      return answer(503, "text/plain", "too many clients\n");
    }
    stream_.expires_never();  // the WebSocket has times of its own
    std::make_shared<WebSocketSession>(std::move(stream_), std::move(ticket_), hub_)
        ->start(parser_.get(), sub_protocol);
  }

  // The first that the client names and we speak; else empty.
  std::string known_sub_protocol() const {
    const std::string names = header(Field::sec_websocket_protocol);
    for (const auto& name : boost::beast::http::token_list(names)) {
      std::string protocol(name);
      if (protocol == kPageProtocol || is_foxglove(protocol)) return protocol;
    }
    return {};
  }

  using Field = boost::beast::http::field;
  std::string header(Field field) const { return std::string(parser_.get()[field]); }

  void answer(int status, const std::string& type, std::string body) {
    response_.result(static_cast<unsigned>(status));
    response_.set(Field::content_type, type);
    response_.set(Field::cache_control, "no-store");
    response_.set("Referrer-Policy", "no-referrer");  // an address may hold the token
    response_.set("Content-Security-Policy", kPagePolicy);
    response_.set("X-Content-Type-Options", "nosniff");
    response_.keep_alive(false);
    response_.body() = std::move(body);
    response_.prepare_payload();
    boost::beast::http::async_write(
        stream_, response_, [self = shared_from_this()](boost::beast::error_code, std::size_t) {
          boost::beast::error_code ignored;
          self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
        });
  }

  boost::beast::tcp_stream stream_;
  ConnectionTicket ticket_;
  ServerHub& hub_;
  boost::beast::flat_buffer buffer_{2 * kMostRequestBytes};
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
};

}  // namespace swivel
