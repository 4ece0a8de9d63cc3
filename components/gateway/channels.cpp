#include "components/gateway/channels.hpp"

#include "components/dds/topics.hpp"
#include "swivel_embedded.hpp"

namespace swivel {
namespace {

// As ROS 2 describes the type to Foxglove; on the wire it is idl/point_cloud2.idl.
constexpr const char* kPointCloud2Schema = R"(std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
)";

template <class Message>
FoxgloveChannel channel(ChannelId id, const Topic<Message>& topic, const std::string& rig,
                        const std::string& type) {
  return {id, topic.full_name(rig), "swivel::msg::" + type, "omgidl", std::string(kSwivelIdl)};
}

}  // namespace

std::vector<FoxgloveChannel> foxglove_channels(const std::string& rig) {
  return {channel(kScanLineChannel, kScanLineTopic, rig, "ScanLine"),
          channel(kAxisChannel, kAxisTopic, rig, "Axis"),
          channel(kSweepChannel, kSweepTopic, rig, "Sweep"),
          channel(kAttitudeChannel, kAttitudeTopic, rig, "Attitude"),
          channel(kCalibrationChannel, kCalibrationTopic, rig, "Calibration"),
          channel(kHealthChannel, kHealthTopic, rig, "Health"),
          {kCloudChannel, kCloudTopic.full_name(rig), "sensor_msgs/msg/PointCloud2", "ros2msg",
           kPointCloud2Schema}};
}

}  // namespace swivel
