// What hangs on a wire: bytes in, bytes out. Pure: time is an argument, and never goes back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace swivel::sim {

class SerialDevice {
 public:
  virtual ~SerialDevice() = default;

  // Somebody connects, or opens the serial port, which resets an Arduino.
  virtual void power_up(std::int64_t now_ns) = 0;
  virtual void receive(std::string_view bytes, std::int64_t now_ns) = 0;
  virtual void advance(std::int64_t now_ns) = 0;
  virtual std::string take_output() = 0;
  // When something may come of itself: call advance() then.
  virtual std::int64_t next_event_ns(std::int64_t now_ns) const = 0;

 protected:
  SerialDevice() = default;
  SerialDevice(const SerialDevice&) = default;
  SerialDevice& operator=(const SerialDevice&) = default;
};

}  // namespace swivel::sim
