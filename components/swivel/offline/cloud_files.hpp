// A cloud as files that other programs open.
//   PCD   binary, organised: a row a line, a column a beam; invalid points are NaN
//   PLY   binary, a list of points, without camera and faces; invalid points are left out, and a
//         comment says how many
// Both hold x, y, z in metres and intensity, as float32, bit for bit.
#pragma once

#include <cstddef>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "hardware/result.hpp"

namespace swivel {

// A file appears under its name only when it is whole.
Outcome write_pcd(const std::string& path, const OrganisedCloud& cloud);

// How many points it left out.
Result<std::size_t> write_ply(const std::string& path, const OrganisedCloud& cloud);

}  // namespace swivel
