// How much a message of anybody's may claim. What claims more is refused before room is made for
// it.
#pragma once

#include <cstdint>

namespace swivel {

inline constexpr std::uint32_t kMostLinesOfASweep = 20000;
inline constexpr std::uint32_t kMostBeamsOfALine = 10000;
inline constexpr std::uint32_t kMostBytesOfACloud = 1U << 28;  // 24 times a cloud of mode 7

}  // namespace swivel
