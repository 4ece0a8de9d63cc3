#include "components/swivel/recorder/timed_cloud_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>

#include "components/mcap/bytes.hpp"

namespace swivel {
namespace {

constexpr std::uint16_t kHeaderSize = 227;
constexpr std::uint16_t kRecordSize = 28;
constexpr std::uint8_t kPointFormat = 1;
constexpr std::uint16_t kAdjustedGpsTime = 1;  // a bit of the global encoding
constexpr std::uint8_t kOneReturnOfOne = 1 | 1 << 3;
constexpr double kScale_m = 1e-4;
constexpr double kLargest_m = 200000.0;  // of an int32 of that scale
// From 1970 to 1980-01-06 where GPS time begins; leap seconds since, as of 2017; the adjustment.
constexpr double kGpsAdjustment_s = -315964800.0 + 18.0 - 1e9;

struct Bounds {
  double least = 0.0;
  double most = 0.0;
  void include(double value, bool first) {
    least = first ? value : std::min(least, value);
    most = first ? value : std::max(most, value);
  }
};

void put(McapEncoder& encoder, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  encoder.u64(bits);
}

void put_words(McapEncoder& encoder, std::string words) {
  words.resize(32, '\0');
  encoder.raw(words);
}

std::string las_header(std::uint32_t points, const std::array<Bounds, 3>& bounds) {
  std::string bytes;
  McapEncoder encoder(bytes);
  encoder.raw("LASF").u16(0).u16(kAdjustedGpsTime).u64(0).u64(0).u8(1).u8(2);
  put_words(encoder, "Swivel");
  put_words(encoder, "swivel export");
  encoder.u16(0).u16(0).u16(kHeaderSize).u32(kHeaderSize).u32(0);
  encoder.u8(kPointFormat).u16(kRecordSize).u32(points);
  encoder.u32(points).u32(0).u32(0).u32(0).u32(0);
  for (int axis = 0; axis < 3; ++axis) put(encoder, kScale_m);
  for (int axis = 0; axis < 3; ++axis) put(encoder, 0.0);
  for (const Bounds& bound : bounds) {
    put(encoder, bound.most);
    put(encoder, bound.least);
  }
  return bytes;
}

std::int32_t scaled(double value_m) {
  return static_cast<std::int32_t>(std::lround(value_m / kScale_m));
}

// Calls with each valid point that a file can hold, and its time.
template <class Take>
void for_each_valid(const OrganisedCloud& cloud, const PointTimes& times, Take take) {
  for (std::size_t line = 0; line < cloud.lines; ++line) {
    for (std::size_t beam = 0; beam < cloud.beams; ++beam) {
      const CloudPoint& point = cloud.points[line * cloud.beams + beam];
      const std::array<double, 3> place_m{static_cast<double>(point.x_m),
                                          static_cast<double>(point.y_m),
                                          static_cast<double>(point.z_m)};
      const bool fits = std::all_of(place_m.begin(), place_m.end(),
                                    [](double value) { return std::abs(value) < kLargest_m; });
      if (fits) take(place_m, static_cast<double>(point.intensity), times.of(line, beam));
    }
  }
}

}  // namespace

std::int64_t PointTimes::of(std::size_t line, std::size_t beam) const {
  return first_ns + std::llround(static_cast<double>(line) * line_period_ns +
                                 static_cast<double>(beam) * beam_period_ns);
}

std::string las_bytes(const OrganisedCloud& cloud, const PointTimes& times) {
  std::string records;
  McapEncoder encoder(records);
  std::array<Bounds, 3> bounds;
  std::uint32_t points = 0;
  for_each_valid(cloud, times, [&](const auto& place_m, double intensity, std::int64_t time_ns) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t value = scaled(place_m[axis]);
      encoder.u32(static_cast<std::uint32_t>(value));
      bounds[axis].include(value * kScale_m, points == 0);
    }
    const double bounded = intensity > 0.0 ? std::min(intensity, 65535.0) : 0.0;
    encoder.u16(static_cast<std::uint16_t>(bounded)).u8(kOneReturnOfOne).u8(0).u8(0).u8(0).u16(0);
    put(encoder, static_cast<double>(time_ns) * 1e-9 + kGpsAdjustment_s);
    ++points;
  });
  return las_header(points, bounds) + records;
}

std::string csv_text(const OrganisedCloud& cloud, const PointTimes& times) {
  std::string text = "x_m,y_m,z_m,intensity,time_ns\n";
  for_each_valid(cloud, times, [&](const auto& place_m, double intensity, std::int64_t time_ns) {
    fmt::format_to(std::back_inserter(text), "{:.6g},{:.6g},{:.6g},{:.0f},{}\n", place_m[0],
                   place_m[1], place_m[2], intensity, time_ns);
  });
  return text;
}

}  // namespace swivel
