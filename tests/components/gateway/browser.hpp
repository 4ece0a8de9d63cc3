// A headless Chromium, driven through its DevTools pipe.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace swivel {

// The page, or Chromium, answered with an error.
struct PageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Browser {
 public:
  // profile: a folder of its own. Throws std::runtime_error where there is no Chromium.
  explicit Browser(const std::string& profile);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& address);
  nlohmann::json evaluate(const std::string& javascript);
  // Until the expression is true; false when the time is over.
  bool await(const std::string& javascript, std::chrono::seconds limit = std::chrono::seconds(20));
  // As a hand does it: at the middle of the element.
  void click(const std::string& selector);
  void drag(double from_x, double from_y, double to_x, double to_y, int steps);
  std::string screenshot();  // PNG

 private:
  nlohmann::json call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object());
  void mouse(const std::string& type, double x, double y, int buttons);
  std::string read_message();

  pid_t process_ = -1;
  int commands_ = -1;
  int answers_ = -1;
  int last_id_ = 0;
  std::string session_;
  std::string unread_;
};

}  // namespace swivel
