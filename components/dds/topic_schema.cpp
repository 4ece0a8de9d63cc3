#include "components/dds/topic_schema.hpp"

#include "idl_text.hpp"

namespace swivel {
namespace {

// PointCloud2 in ROS 2's own language: a type, then those that it uses.
constexpr const char* kPointCloud2Definition = R"msg(std_msgs/Header header
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
)msg";

}  // namespace

TopicSchema schema_of(const AnyTopic& topic) {
  if (topic.for_ros) return {"sensor_msgs/msg/PointCloud2", "ros2msg", kPointCloud2Definition};
  return {topic.make_type()->getName(), "omgidl", kSwivelIdl};
}

}  // namespace swivel
