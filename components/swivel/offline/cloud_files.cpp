#include "components/swivel/offline/cloud_files.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace swivel {
namespace {

pcl::PCLPointField field(const char* name, std::uint32_t offset) {
  pcl::PCLPointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = pcl::PCLPointField::FLOAT32;
  field.count = 1;
  return field;
}

pcl::PCLPointCloud2 pcl_cloud(const CloudPoint* points, std::size_t width, std::size_t height) {
  pcl::PCLPointCloud2 cloud;
  cloud.fields = {field("x", 0), field("y", 4), field("z", 8), field("intensity", 12)};
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.point_step = sizeof(CloudPoint);
  cloud.row_step = static_cast<std::uint32_t>(width * sizeof(CloudPoint));
  cloud.data.resize(width * height * sizeof(CloudPoint));
  if (!cloud.data.empty()) std::memcpy(cloud.data.data(), points, cloud.data.size());
  return cloud;
}

// Written by ourselves: PCL adds a face element, cannot leave a comment, refuses an empty cloud.
std::string ply_header(std::size_t points, std::size_t left_out) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\ncomment swivel: " << left_out
         << " invalid points are left out\nelement vertex " << points
         << "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
         << "end_header\n";
  return header.str();
}

// Runs write(part) and gives the file its name, or says why not. PCL reports some failures by
// its return value and others by an exception.
template <class Write>
Outcome write_whole(const std::string& path, Write write) {
  const std::string part = path + ".part";
  std::string reason;
  try {
    if (write(part) < 0) reason = "it cannot be written";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  std::error_code error;
  if (reason.empty()) std::filesystem::rename(part, path, error);
  if (reason.empty() && !error) return Done{};
  if (reason.empty()) reason = error.message();
  std::filesystem::remove(part, error);
  return Failure{path + ": " + reason + "; is the folder there, writable, and the disk not full?"};
}

}  // namespace

Outcome write_pcd(const std::string& path, const OrganisedCloud& cloud) {
  const auto whole = pcl_cloud(cloud.points.data(), cloud.beams, cloud.lines);
  return write_whole(
      path, [&](const std::string& part) { return pcl::PCDWriter().writeBinary(part, whole); });
}

Result<std::size_t> write_ply(const std::string& path, const OrganisedCloud& cloud) {
  std::vector<CloudPoint> valid;
  valid.reserve(cloud.points.size());
  for (const CloudPoint& point : cloud.points)
    if (point.valid()) valid.push_back(point);

  const std::size_t left_out = cloud.points.size() - valid.size();
  const Outcome written = write_whole(path, [&](const std::string& part) {
    std::ofstream file(part, std::ios::binary);
    file << ply_header(valid.size(), left_out);
    file.write(reinterpret_cast<const char*>(valid.data()),
               static_cast<std::streamsize>(valid.size() * sizeof(CloudPoint)));
    file.close();
    return file ? 0 : -1;
  });
  if (!written) return Failure{written.reason()};
  return left_out;
}

}  // namespace swivel
