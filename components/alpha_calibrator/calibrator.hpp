// A calibration run: asks for sweeps, takes what they bring, fits, and says how it goes.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "components/alpha_calibrator/alpha_calibration.hpp"
#include "components/common/sweep_requester.hpp"
#include "swivel/idl/point_cloud2.h"
#include "swivel/idl/swivel.h"

namespace swivel {

class Calibrator {
 public:
  struct Outputs {
    std::function<void(const msg::SweepRequest&)> request_sweeps;
    std::function<void(const msg::CalibrationProgress&)> tell;
    std::function<void(const msg::Calibration&)> publish;
  };

  Calibrator(const RigFile& rig, Outputs outputs);

  void take(const msg::CalibrationRequest& request);
  void take(const msg::Sweep& sweep);
  void take(const msg::Attitude& attitude);
  void take(const sensor_msgs::msg::dds_::PointCloud2_& raw_cloud);
  void name_lidar(const LidarName& lidar) { lidar_ = lidar; }

  // Every second or so.
  void check(std::chrono::steady_clock::time_point now);

  bool running() const { return run_.has_value(); }

 private:
  struct Run {
    AlphaCalibration calibration;
    std::uint64_t request_id;
    std::size_t wanted;
    std::size_t left_out = 0;
    std::set<std::uint64_t> sweeps;  // of our request
    std::set<std::uint64_t> done;
    std::map<std::int64_t, msg::Attitude> attitudes;  // by stamp, until their cloud is here
  };

  std::string why_not_taken(const msg::CalibrationRequest& request) const;
  void match();
  void leave_out(std::uint64_t sweep_id, const std::string& why);
  void count(std::uint64_t sweep_id, const std::string& words);
  void finish();
  void refuse(const std::string& why);
  void tell(msg::CalibrationState state, const std::string& words);

  RigFile rig_;
  Outputs outputs_;
  SweepRequester requester_;
  LidarName lidar_;
  std::optional<Run> run_;
  std::uint64_t last_request_id_ = 0;
  OrganisedCloud cloud_;  // the last one, and its stamp
  std::optional<std::int64_t> cloud_stamp_ns_;
  bool news_ = false;
  std::chrono::steady_clock::time_point last_news_{};
};

}  // namespace swivel
