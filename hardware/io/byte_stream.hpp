// A connection to a device: TCP, or a serial line (a pty included).
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "hardware/io/wake_up.hpp"
#include "hardware/io/wire_tap.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct Received {
  enum class Kind {
    kData,
    kTimeout,
    kInterrupted,  // the wake-up was notified
    kClosed,       // by the other side, or the device was unplugged
    kError
  };
  Kind kind = Kind::kTimeout;
  std::string bytes;   // of kData, never empty
  std::string reason;  // of kClosed and kError
};

class ByteStream {
 public:
  // `address` is one of
  //   tcp://HOST:PORT       HOST a name, 192.168.0.10 or [fe80::1]
  //   /dev/ttyACM0[@BAUD]   8N1 without flow control, 115200 unless BAUD says otherwise; DTR as
  //                         the system has it. Locked: a second program is refused
  // A failure says what to do about it. Ends early when `wake_up` is notified. `tap` sees all that
  // passes from here on.
  static Result<ByteStream> open(const std::string& address, std::chrono::milliseconds timeout,
                                 const WakeUp* wake_up = nullptr, WireTap tap = {});

  ByteStream(ByteStream&& other) noexcept;
  ByteStream& operator=(ByteStream&& other) noexcept;
  ~ByteStream();

  // Waits for bytes, at most `timeout`, and returns those that are there.
  Received read_some(std::chrono::milliseconds timeout, const WakeUp* wake_up = nullptr);

  // Not interruptible: a command that stops a motor must go out whole. After a failure an
  // unknown part of the bytes is out.
  Outcome write_all(std::string_view bytes, std::chrono::milliseconds timeout);

  const std::string& address() const { return address_; }
  int descriptor() const { return descriptor_; }  // stays ours

 private:
  ByteStream(int descriptor, bool is_socket, std::string address, WireTap tap);
  Received take(std::string bytes);
  Received lost(Received how);
  void tell(WireEvent::Kind kind, std::string_view bytes = {}) const;

  int descriptor_ = -1;
  bool is_socket_ = false;
  std::string address_;
  WireTap tap_;
};

}  // namespace swivel
