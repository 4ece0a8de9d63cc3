// The topics: name, type and generated support, in one table. A topic's QoS is the profile of
// the same name in config/dds_profiles.xml.
#pragma once

#include <cstdint>
#include <string>

#include "swivel/idl/point_cloud2.h"
#include "swivel/idl/point_cloud2PubSubTypes.h"
#include "swivel/idl/swivel.h"
#include "swivel/idl/swivelPubSubTypes.h"

namespace swivel {

using PointCloud2 = sensor_msgs::msg::dds_::PointCloud2_;
using PointField = sensor_msgs::msg::dds_::PointField_;

template <class Message>
struct Topic {
  const char* name;  // after the rig's name; also the name of the QoS profile
  bool for_ros;      // under rt/, where ROS 2 looks

  std::string full_name(const std::string& rig) const {
    return (for_ros ? "rt/" : "") + rig + "/" + name;
  }
};

inline constexpr Topic<msg::ScanLine> kScanLineTopic{"scan_line", false};
inline constexpr Topic<msg::Axis> kAxisTopic{"axis", false};
inline constexpr Topic<msg::Sweep> kSweepTopic{"sweep", false};
inline constexpr Topic<msg::SweepRequest> kSweepRequestTopic{"sweep_request", false};
inline constexpr Topic<PointCloud2> kRawCloudTopic{"raw_cloud", true};
inline constexpr Topic<PointCloud2> kCloudTopic{"cloud", true};
inline constexpr Topic<msg::Attitude> kAttitudeTopic{"attitude", false};
inline constexpr Topic<msg::Calibration> kCalibrationTopic{"calibration", false};
inline constexpr Topic<msg::CalibrationRequest> kCalibrationRequestTopic{"calibration_request",
                                                                         false};
inline constexpr Topic<msg::CalibrationProgress> kCalibrationProgressTopic{"calibration_progress",
                                                                           false};
inline constexpr Topic<msg::Health> kHealthTopic{"health", false};
inline constexpr Topic<msg::WireBytes> kWireTopic{"wire", false};

template <class Message>
struct TypeSupportOf;
template <>
struct TypeSupportOf<msg::ScanLine> {
  using Type = msg::ScanLinePubSubType;
};
template <>
struct TypeSupportOf<msg::Axis> {
  using Type = msg::AxisPubSubType;
};
template <>
struct TypeSupportOf<msg::Sweep> {
  using Type = msg::SweepPubSubType;
};
template <>
struct TypeSupportOf<msg::SweepRequest> {
  using Type = msg::SweepRequestPubSubType;
};
template <>
struct TypeSupportOf<msg::Attitude> {
  using Type = msg::AttitudePubSubType;
};
template <>
struct TypeSupportOf<msg::Calibration> {
  using Type = msg::CalibrationPubSubType;
};
template <>
struct TypeSupportOf<msg::CalibrationRequest> {
  using Type = msg::CalibrationRequestPubSubType;
};
template <>
struct TypeSupportOf<msg::CalibrationProgress> {
  using Type = msg::CalibrationProgressPubSubType;
};
template <>
struct TypeSupportOf<msg::Health> {
  using Type = msg::HealthPubSubType;
};
template <>
struct TypeSupportOf<msg::WireBytes> {
  using Type = msg::WireBytesPubSubType;
};
template <>
struct TypeSupportOf<PointCloud2> {
  using Type = sensor_msgs::msg::dds_::PointCloud2_PubSubType;
};

// The rig's name and the sequence number, which every message of ours carries and PointCloud2,
// being ROS 2's, does not.
template <class Message>
void stamp_message(Message& message, const std::string& rig, std::uint64_t number) {
  message.rig(rig);
  message.sequence_number(number);
}
inline void stamp_message(PointCloud2&, const std::string&, std::uint64_t) {}

template <class Message>
std::uint64_t number_of(const Message& message) {
  return message.sequence_number();
}
inline std::uint64_t number_of(const PointCloud2&) {
  return 0;
}

template <class Message>
constexpr bool is_numbered(const Message&) {
  return true;
}
inline bool is_numbered(const PointCloud2&) {
  return false;
}

}  // namespace swivel
