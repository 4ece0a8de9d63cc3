#include "components/common/cloud_message.hpp"

#include <array>
#include <cstring>

#include "components/dds/bounds.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/PointField
constexpr std::array<const char*, 4> kFieldNames{"x", "y", "z", "intensity"};

std::vector<sensor_msgs::msg::dds_::PointField_> make_fields() {
  std::vector<sensor_msgs::msg::dds_::PointField_> fields(kFieldNames.size());
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    fields[i].name(kFieldNames[i]);
    fields[i].offset(4 * i);
    fields[i].datatype(kFloat32);
    fields[i].count(1);
  }
  return fields;
}

bool has_our_fields(const PointCloud2Message& message) {
  const auto& fields = message.fields();
  if (fields.size() != kFieldNames.size()) return false;
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name() != kFieldNames[i] || fields[i].offset() != 4 * i ||
        fields[i].datatype() != kFloat32 || fields[i].count() != 1) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string start_frame(const std::string& rig) {
  return rig + "/start";
}
std::string base_frame(const std::string& rig) {
  return rig + "/base";
}

void to_message(const OrganisedCloud& cloud, std::int64_t first_beam_time_ns,
                const std::string& frame_id, PointCloud2Message& message) {
  const std::int64_t part_ns = (first_beam_time_ns % kSecondNs + kSecondNs) % kSecondNs;
  const std::int64_t whole_s = (first_beam_time_ns - part_ns) / kSecondNs;
  message.header().stamp().sec(static_cast<std::int32_t>(whole_s));
  message.header().stamp().nanosec(static_cast<std::uint32_t>(part_ns));
  message.header().frame_id(frame_id);
  message.height(static_cast<std::uint32_t>(cloud.lines));
  message.width(static_cast<std::uint32_t>(cloud.beams));
  message.fields(make_fields());
  message.is_bigendian(false);
  message.point_step(sizeof(CloudPoint));
  message.row_step(static_cast<std::uint32_t>(cloud.beams * sizeof(CloudPoint)));
  message.is_dense(false);
  message.data().resize(cloud.points.size() * sizeof(CloudPoint));
  if (!cloud.points.empty()) {
    std::memcpy(message.data().data(), cloud.points.data(), message.data().size());
  }
}

std::string wrong_with(const PointCloud2Message& message) {
  if (!has_our_fields(message) || message.point_step() != sizeof(CloudPoint) ||
      message.is_bigendian()) {
    return "its fields are not x, y, z, intensity as little-endian float32";
  }
  if (message.height() > kMostLinesOfASweep || message.width() > kMostBeamsOfALine) {
    return "it claims " + std::to_string(message.height()) + " x " +
           std::to_string(message.width()) + " points";
  }
  const std::uint64_t bytes =
      std::uint64_t{message.height()} * message.width() * sizeof(CloudPoint);
  if (bytes > kMostBytesOfACloud || bytes != message.data().size() ||
      message.row_step() != message.width() * sizeof(CloudPoint)) {
    return "its data does not have the size that its shape asks for";
  }
  return {};
}

std::string from_message(const PointCloud2Message& message, OrganisedCloud& cloud) {
  if (std::string wrong = wrong_with(message); !wrong.empty()) return wrong;
  cloud.lines = message.height();
  cloud.beams = message.width();
  cloud.points.resize(cloud.lines * cloud.beams);
  if (!cloud.points.empty()) {
    std::memcpy(cloud.points.data(), message.data().data(), message.data().size());
  }
  return {};
}

std::int64_t stamp_ns(const PointCloud2Message& message) {
  return message.header().stamp().sec() * kSecondNs + message.header().stamp().nanosec();
}

}  // namespace swivel
