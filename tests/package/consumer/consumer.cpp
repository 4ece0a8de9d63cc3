// Another program that has nothing of Swivel but the installed package.
#include <swivel/idl/point_cloud2PubSubTypes.h>
#include <swivel/idl/swivelPubSubTypes.h>

#include <cstring>

int main() {
  swivel::msg::ScanLinePubSubType line;
  sensor_msgs::msg::dds_::PointCloud2_PubSubType cloud;
  const bool named = std::strcmp(line.getName(), "swivel::msg::ScanLine") == 0 &&
                     std::strcmp(cloud.getName(), "sensor_msgs::msg::dds_::PointCloud2_") == 0;
  return named ? 0 : 1;
}
