// A rig file (config/rigs/*.yaml), read and checked: everything that differs from rig to rig.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "calibration/rig.hpp"

namespace swivel {

struct LidarSection {
  std::string address;
  bool intensities = true;
  bool stamp_at_rear_centre = true;
};

struct StepperSection {
  std::string address;
  double home_angle_deg = 0.0;
  double cable_limit_deg = 0.0;
  double max_speed_deg_s = 0.0;
  double return_speed_deg_s = 0.0;
  double settle_s = 0.0;
  double minimum_step_rate_hz = 0.0;
};

struct ModesSection {
  double line_period_s = 0.025;  // nominal, of the lidar
  double sweep_angle_deg = 180.0;
  std::map<int, int> lines;  // mode -> scan lines of a sweep
};

enum class Timing {
  kPerBeam,  // each beam at its own instant, the dead time counted
  kEq7       // the paper's even spread of all points over the sweep (Yuan 2021, eq. 7)
};

struct RigFile {
  std::string path;
  std::string rig;
  std::optional<LidarSection> lidar;      // absent: recordings only
  std::optional<StepperSection> stepper;  // absent: the axis is turned by something else
  bool axis_measured = false;
  RigGeometry geometry;
  std::optional<PlateGeometry> plate;
  Timing timing = Timing::kPerBeam;
  std::string estimator;
  ModesSection modes;
};

// Turned about the fixed X, then Y, then Z axis; and back, pitch between -90 and 90 deg.
Eigen::Isometry3d transform_of(const std::array<double, 3>& xyz_mm,
                               const std::array<double, 3>& rpy_deg);
Eigen::Vector3d rpy_deg_of(const Eigen::Matrix3d& rotation);

// Throws ConfigurationError with file and line.
RigFile load_rig_file(const std::string& path);

}  // namespace swivel
