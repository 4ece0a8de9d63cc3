#include "tests/components/gateway/raw_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

namespace swivel {

RawClient::RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{10, 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("cannot connect");
}

RawClient::~RawClient() {
  close(socket_);
}

void RawClient::send(const std::string& bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (count <= 0) return;  // closed: reading shows it
    done += static_cast<std::size_t>(count);
  }
}

bool RawClient::read_more() {
  std::array<char, 65536> bytes{};
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
  if (count > 0) unread_.append(bytes.data(), static_cast<std::size_t>(count));
  out_of_patience_ = count < 0 && errno == EAGAIN;
  return count > 0;
}

bool RawClient::read_up_to(std::size_t bytes) {
  while (unread_.size() < bytes)
    if (!read_more()) return false;
  return true;
}

bool RawClient::closed() {
  while (read_more()) {
  }
  return !out_of_patience_;
}

std::string RawClient::read_to_end() {
  while (read_more()) {
  }
  return unread_;
}

std::string RawClient::read_head() {
  while (unread_.find("\r\n\r\n") == std::string::npos)
    if (!read_more()) return unread_;
  const std::size_t end = unread_.find("\r\n\r\n") + 4;
  const std::string head = unread_.substr(0, end);
  unread_.erase(0, end);
  return head;
}

std::string RawClient::open_web_socket(const std::string& sub_protocol, const std::string& host,
                                       const std::string& more_headers, const std::string& target) {
  send("GET " + target + " HTTP/1.1\r\nHost: " + host +
       "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: " +
       sub_protocol + "\r\n" + more_headers + "\r\n");
  return read_head();
}

void RawClient::send_frame(int opcode, const std::string& payload) const {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80 | payload.size());
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8)
      frame += static_cast<char>(payload.size() >> shift & 0xFFU);
  }
  frame.append(4, '\0');  // a mask that changes nothing
  send(frame + payload);
}

std::optional<RawClient::Message> RawClient::read_message() {
  Message message{0, {}};
  while (read_up_to(2)) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(unread_[at]); };
    const std::size_t length_bytes = byte(1) == 127 ? 8 : byte(1) == 126 ? 2 : 0;
    if (!read_up_to(2 + length_bytes)) return std::nullopt;
    std::uint64_t length = length_bytes == 0 ? byte(1) : 0;
    for (std::size_t at = 0; at < length_bytes; ++at) length = length << 8 | byte(2 + at);
    if (!read_up_to(2 + length_bytes + length)) return std::nullopt;
    if ((byte(0) & 0x0FU) != 0) message.opcode = byte(0) & 0x0F;
    const bool last = (byte(0) & 0x80U) != 0;
    message.payload += unread_.substr(2 + length_bytes, length);
    unread_.erase(0, 2 + length_bytes + length);
    if (last) return message;
  }
  return std::nullopt;
}

std::string get(std::uint16_t port, const std::string& target, const std::string& more_headers,
                const std::string& host) {
  RawClient client(port);
  client.send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more_headers + "\r\n");
  return client.read_to_end();
}

int status_of(const std::string& answer) {
  return answer.size() < 12 ? 0 : std::atoi(answer.c_str() + 9);
}

}  // namespace swivel
