// Sees all that passes over a ByteStream, byte for byte, for who wants to keep it.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

namespace swivel {

struct WireEvent {
  enum class Kind {
    kOpened,
    kSent,
    kReceived,
    kHungUp,  // by the other side, or the device was unplugged
    kClosed   // by us
  };
  Kind kind = Kind::kOpened;
  std::int64_t time_ns = 0;
  std::string_view bytes;  // of kSent and kReceived; gone once the call returns
};

// Called by whoever reads or writes, who waits for it.
using WireTap = std::function<void(const WireEvent&)>;

}  // namespace swivel
