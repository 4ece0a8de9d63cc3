// A device that says again what a captured one said, when it is asked the same, and as quickly. One
// connection after the other, as they were captured; after the last one the first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/sim/conversation.hpp"
#include "hardware/sim/serial_device.hpp"

namespace swivel::sim {

class CapturedDevice : public SerialDevice {
 public:
  // Told, in words, what is not as in the capture, and when it begins anew.
  using OnNews = std::function<void(const std::string& words)>;

  // at_once: the characters that the device acts on without a line's end; the first is one that
  // asks how it stands, which may come more or less often than in the capture.
  CapturedDevice(std::string name, std::vector<Conversation> conversations, std::string at_once,
                 OnNews on_news);

  void power_up(std::int64_t now_ns) override;
  void receive(std::string_view bytes, std::int64_t now_ns) override;
  void advance(std::int64_t now_ns) override;
  std::string take_output() override;
  std::int64_t next_event_ns(std::int64_t now_ns) const override;

  // Told of every line that is answered, with the time at which it was captured.
  using OnLine =
      std::function<void(const std::string& line, std::int64_t captured_ns, std::int64_t now_ns)>;
  void on_line(OnLine on_line) { on_line_ = std::move(on_line); }

  // What is streamed goes on with what was captured at that time, whether it is past or to come.
  void align(std::int64_t captured_ns, std::int64_t now_ns);

  // The captured device hangs up now; once.
  bool takes_leave();
  std::uint64_t differences() const { return differences_; }

 private:
  void take(const std::string& request, std::int64_t now_ns);
  bool asks_how_it_stands(const std::string& request) const;
  bool found_among_questions(const std::string& request);
  bool found_later(const std::string& request);
  void begin(std::size_t exchange, std::int64_t now_ns);
  void differ(const std::string& words);
  const std::vector<Exchange>& exchanges() const;

  const std::string name_;
  const std::vector<Conversation> conversations_;
  const std::string at_once_;
  const OnNews on_news_;
  OnLine on_line_;
  std::size_t connections_ = 0;
  std::size_t exchange_ = 0;   // under way
  std::size_t answer_ = 0;     // of it, the next
  std::int64_t asked_ns_ = 0;  // when it began
  std::string last_standing_;  // the last answer to the question how it stands
  std::string received_;
  std::string output_;
  bool hangs_up_ = false;
  std::uint64_t differences_ = 0;
};

}  // namespace swivel::sim
