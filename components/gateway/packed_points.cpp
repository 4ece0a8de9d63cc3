#include "components/gateway/packed_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace swivel {
namespace {

constexpr float kFarthest_mm = 32767.0F;

// Not std::round, which is a call a point.
std::int16_t rounded(float value_mm) {
  return static_cast<std::int16_t>(value_mm + std::copysign(0.5F, value_mm));
}

// False for NaN and infinity, too.
bool fits(float value_mm) {
  return std::abs(value_mm) < kFarthest_mm;
}

std::uint8_t packed_intensity(float intensity) {
  if (!(intensity > 0.0F)) return 0;
  return static_cast<std::uint8_t>(std::sqrt(std::min(intensity, 65025.0F)));
}

}  // namespace

PackedPoint packed(const CloudPoint& point) {
  PackedPoint packed{0, 0, 0, packed_intensity(point.intensity), PointFlag::kNone};
  if (!point.valid()) return packed;
  const float x_mm = 1000.0F * point.x_m;
  const float y_mm = 1000.0F * point.y_m;
  const float z_mm = 1000.0F * point.z_m;
  packed.flag = PointFlag::kFar;
  if (!fits(x_mm) || !fits(y_mm) || !fits(z_mm)) return packed;
  return {rounded(x_mm), rounded(y_mm), rounded(z_mm), packed.root_intensity, PointFlag::kPoint};
}

std::string packed_frame(const FrameHead& head, const void* points) {
  std::string frame(sizeof head + head.points() * sizeof(PackedPoint), '\0');
  std::memcpy(frame.data(), &head, sizeof head);
  const auto* from = static_cast<const char*>(points);
  char* to = frame.data() + sizeof head;
  for (std::size_t index = 0; index < head.points(); ++index) {
    CloudPoint point;
    std::memcpy(&point, from + index * sizeof point, sizeof point);
    const PackedPoint small = packed(point);
    std::memcpy(to + index * sizeof small, &small, sizeof small);
  }
  return frame;
}

}  // namespace swivel
