// What goes to a client as one WebSocket message.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace swivel {

struct Frame {
  bool text = false;
  std::string head;                         // this client's own
  std::shared_ptr<const std::string> body;  // shared by all clients; may be null

  std::size_t bytes() const { return head.size() + (body ? body->size() : 0); }
};

inline Frame text_frame(std::string text) {
  return {true, {}, std::make_shared<const std::string>(std::move(text))};
}

inline Frame binary_frame(std::string bytes) {
  return {false, {}, std::make_shared<const std::string>(std::move(bytes))};
}

}  // namespace swivel
