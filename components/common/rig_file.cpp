#include "components/common/rig_file.hpp"

#include <algorithm>
#include <cmath>

#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

constexpr Range kLength{-100000.0, 100000.0};

std::string read_rig_name(YamlSection& file) {
  std::string name = file.text("rig");
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (name.empty() || name.size() > 32 || !plain) {
    file.refuse("rig", "must be 1 to 32 of a-z, 0-9 and _, since topics are named after it");
  }
  return name;
}

LidarSection read_lidar(YamlSection section) {
  LidarSection lidar;
  lidar.address = section.text("address");
  lidar.intensities = section.flag("intensities", true);
  if (section.has("stamp_origin")) {
    lidar.stamp_at_rear_centre =
        section.one_of("stamp_origin", {"first_beam", "rear_centre"}) == "rear_centre";
  }
  section.finish();
  return lidar;
}

StepperSection read_stepper(YamlSection section) {
  StepperSection stepper;
  stepper.address = section.text("address");
  stepper.home_angle_deg = section.number("home_angle_deg", kAnyAngle_deg);
  stepper.cable_limit_deg = section.number("cable_limit_deg", {1.0, 3600.0});
  stepper.max_speed_deg_s = section.number("max_speed_deg_s", {1.0, 720.0}, 720.0);
  stepper.return_speed_deg_s = section.number("return_speed_deg_s", {1.0, 720.0});
  stepper.settle_s = section.number("settle_s", {0.0, 5.0});
  stepper.minimum_step_rate_hz = section.number("minimum_step_rate_hz", {0.0, 1e5}, 30.0);
  section.finish();
  return stepper;
}

Eigen::Isometry3d read_transform(YamlSection& section) {
  const auto xyz_mm = section.numbers("xyz_mm", 3, kLength);
  const auto rpy_deg = section.numbers("rpy_deg", 3, kAnyAngle_deg);
  return transform_of({xyz_mm[0], xyz_mm[1], xyz_mm[2]}, {rpy_deg[0], rpy_deg[1], rpy_deg[2]});
}

void read_axis(YamlSection section, RigFile& rig) {
  rig.axis_measured = section.one_of("source", {"commanded", "measured"}) == "measured";
  rig.geometry.T_base_axis = read_transform(section);
  section.finish();
}

void read_mounting(YamlSection section, RigFile& rig) {
  rig.geometry.T_axis_lidar = read_transform(section);
  rig.geometry.bias_rad = rad_from_deg(section.number("bias_deg", {-45.0, 45.0}, 0.0));
  section.finish();
}

PlateGeometry read_plate(YamlSection section) {
  constexpr Range kPlateLength{1.0, 1000.0};
  PlateGeometry plate;
  plate.alpha_rad = rad_from_deg(section.number("alpha_deg", kAnyAngle_deg));
  plate.base_distance_m = m_from_mm(section.number("base_distance_mm", kPlateLength));
  plate.hypotenuse_m = m_from_mm(section.number("hypotenuse_mm", kPlateLength));
  plate.depth_m = m_from_mm(section.number("depth_mm", kPlateLength));
  plate.ring_inner_m = m_from_mm(section.number("ring_inner_mm", kPlateLength));
  plate.ring_outer_m = m_from_mm(section.number("ring_outer_mm", kPlateLength));
  plate.ring_thickness_m = m_from_mm(section.number("ring_thickness_mm", kPlateLength));
  if (plate.ring_inner_m >= plate.ring_outer_m) {
    section.refuse("ring_outer_mm", "must be larger than ring_inner_mm");
  }
  section.finish();
  return plate;
}

ModesSection read_modes(YamlSection section) {
  ModesSection modes;
  modes.line_period_s = 1e-3 * section.number("line_period_ms", {5.0, 1000.0}, 25.0);
  modes.sweep_angle_deg = section.number("sweep_angle_deg", {1.0, 360.0});
  YamlSection lines = section.section("lines");
  for (const std::string& key : lines.keys()) {
    const bool whole =
        !key.empty() && key.size() <= 3 && key[0] != '0' &&
        std::all_of(key.begin(), key.end(), [](char c) { return c >= '0' && c <= '9'; });
    const int mode = whole ? std::stoi(key) : 0;
    if (mode < 1 || mode > 255) lines.refuse(key, "a mode is a number from 1 to 255");
    modes.lines[mode] = lines.integer(key, {2, 20000});
  }
  if (modes.lines.empty()) section.refuse("lines", "must name at least one mode");
  section.finish();
  return modes;
}

}  // namespace

Eigen::Isometry3d transform_of(const std::array<double, 3>& xyz_mm,
                               const std::array<double, 3>& rpy_deg) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(
      Eigen::Vector3d(m_from_mm(xyz_mm[0]), m_from_mm(xyz_mm[1]), m_from_mm(xyz_mm[2])));
  transform.rotate(Eigen::AngleAxisd(rad_from_deg(rpy_deg[2]), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(rad_from_deg(rpy_deg[1]), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(rad_from_deg(rpy_deg[0]), Eigen::Vector3d::UnitX()));
  return transform;
}

Eigen::Vector3d rpy_deg_of(const Eigen::Matrix3d& rotation) {
  const double level = std::hypot(rotation(0, 0), rotation(1, 0));
  return {deg_from_rad(std::atan2(rotation(2, 1), rotation(2, 2))),
          deg_from_rad(std::atan2(-rotation(2, 0), level)),
          deg_from_rad(std::atan2(rotation(1, 0), rotation(0, 0)))};
}

RigFile load_rig_file(const std::string& path) {
  YamlSection file = YamlSection::load(path);
  RigFile rig;
  rig.path = path;
  rig.rig = read_rig_name(file);
  if (auto section = file.section_if_present("lidar")) rig.lidar = read_lidar(*section);
  if (auto section = file.section_if_present("stepper")) rig.stepper = read_stepper(*section);
  read_axis(file.section("axis"), rig);
  read_mounting(file.section("mounting"), rig);
  if (auto section = file.section_if_present("plate")) rig.plate = read_plate(*section);
  if (file.has("timing")) {
    rig.timing =
        file.one_of("timing", {"per_beam", "eq7"}) == "eq7" ? Timing::kEq7 : Timing::kPerBeam;
  }
  rig.estimator = file.text("estimator", "plate_outline");
  rig.modes = read_modes(file.section("modes"));
  file.finish();
  return rig;
}

}  // namespace swivel
