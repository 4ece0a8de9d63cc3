// Points as the page gets them: 8 bytes each, where a cloud's message has 16.
//
//   frame  = head, then line_count * beams points, all little endian
//   head   = six uint32: kind (1 lines of a running sweep, 2 a cloud), number of the picture,
//            lines and beams of the whole picture, first_line and line_count of this frame
//   point  = int16 x, y, z in mm; uint8 root of the intensity; uint8 flag
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "calibration/organised_cloud.hpp"

namespace swivel {

enum class PointFlag : std::uint8_t {
  kNone = 0,   // no return, or its line is missing
  kPoint = 1,  //
  kFar = 2     // a return from too far for 16 bits; its coordinates are 0
};

struct PackedPoint {
  std::int16_t x_mm;
  std::int16_t y_mm;
  std::int16_t z_mm;
  std::uint8_t root_intensity;
  PointFlag flag;
};
static_assert(sizeof(PackedPoint) == 8, "sent as it is");

// Takes any bits: a cloud may come from anybody.
PackedPoint packed(const CloudPoint& point);

enum class FrameKind : std::uint32_t { kLines = 1, kCloud = 2 };

struct FrameHead {
  FrameKind kind = FrameKind::kLines;
  std::uint32_t number = 0;
  std::uint32_t lines = 0;
  std::uint32_t beams = 0;
  std::uint32_t first_line = 0;
  std::uint32_t line_count = 0;

  std::size_t points() const { return std::size_t{line_count} * beams; }
};
static_assert(sizeof(FrameHead) == 24, "sent as it is");

// A frame of head.points() points, which stand in `points` as CloudPoints one after the other,
// at any alignment.
std::string packed_frame(const FrameHead& head, const void* points);

}  // namespace swivel
