// A client that knows nothing but its socket, and so can do anything: half requests, frames by
// hand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace swivel {

class RawClient {
 public:
  explicit RawClient(std::uint16_t port);  // of 127.0.0.1
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void send(const std::string& bytes) const;
  // Until the other side closes, or has nothing more to say for 10 s.
  std::string read_to_end();
  std::string read_head();  // of an HTTP answer
  // True once the other side has closed.
  bool closed();

  // The answer's head.
  std::string open_web_socket(const std::string& sub_protocol, const std::string& host,
                              const std::string& more_headers = "",
                              const std::string& target = "/");
  void send_frame(int opcode, const std::string& payload) const;

  struct Message {
    int opcode;  // 1 text, 2 binary, 8 close
    std::string payload;
  };
  std::optional<Message> read_message();  // its fragments joined

 private:
  bool read_more();
  bool read_up_to(std::size_t bytes);

  int socket_ = -1;
  bool out_of_patience_ = false;
  std::string unread_;
};

std::string get(std::uint16_t port, const std::string& target, const std::string& more_headers = "",
                const std::string& host = "localhost");
int status_of(const std::string& answer);

}  // namespace swivel
