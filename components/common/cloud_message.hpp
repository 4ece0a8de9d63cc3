// The one home of the conversion between clouds and their message, PointCloud2.
#pragma once

#include <cstdint>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "swivel/idl/point_cloud2.h"

namespace swivel {

using PointCloud2Message = sensor_msgs::msg::dds_::PointCloud2_;

// frame_id of a cloud in frame O' of its start position, and of one in the rig's base.
std::string start_frame(const std::string& rig);
std::string base_frame(const std::string& rig);

void to_message(const OrganisedCloud& cloud, std::int64_t first_beam_time_ns,
                const std::string& frame_id, PointCloud2Message& message);

// Other writers may send anything: layout, sizes and bounds. Empty if the message's data are
// height * width CloudPoints.
[[nodiscard]] std::string wrong_with(const PointCloud2Message& message);

// Fills cloud, whose memory is used again; else says what is wrong with the message.
[[nodiscard]] std::string from_message(const PointCloud2Message& message, OrganisedCloud& cloud);

std::int64_t stamp_ns(const PointCloud2Message& message);

}  // namespace swivel
