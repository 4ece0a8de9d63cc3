// The sweep that is measured: mode 7, the longest.
#pragma once

#include <cstddef>
#include <cstdint>

namespace swivel {

constexpr std::uint32_t kLines = 640;
constexpr std::size_t kBeams = 1081;

}  // namespace swivel
