// A calibration run: asks for sweeps, takes what they bring, fits, and says how it goes. Alpha is
// found in raw clouds and their attitudes; the mounting in what lidar and axis said, since a cloud
// is made with a mounting already.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "components/alpha_calibrator/alpha_calibration.hpp"
#include "components/alpha_calibrator/mounting_calibration.hpp"
#include "components/cloud_assembler/assembler.hpp"
#include "components/common/calibration_use.hpp"
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

  // What is known already, as from an earlier start. Says why it is refused, or nothing.
  std::string know(const msg::Calibration& calibration) { return known_.take(calibration); }

  void take(const msg::CalibrationRequest& request);
  void take(const msg::ScanLine& line);
  void take(const msg::Axis& axis);
  void take(const msg::Sweep& sweep);
  void take(const msg::Attitude& attitude);
  void take(const sensor_msgs::msg::dds_::PointCloud2_& raw_cloud);
  // Says why what is known is refused from now on, or nothing.
  std::string name_lidar(const LidarName& lidar);

  // Every second or so.
  void check(std::chrono::steady_clock::time_point now);

  bool running() const { return run_.has_value(); }
  std::uint64_t clouds_refused() const { return clouds_refused_; }

 private:
  struct AlphaRun {
    AlphaCalibration calibration;
    std::map<std::int64_t, msg::Attitude> attitudes;  // by stamp, until their cloud is here
  };
  struct SweepFit {
    msg::Sweep sweep;
    std::future<MountingResult> result;
  };
  // Raised when it goes, with the run that holds it.
  class StopFlag {
   public:
    StopFlag() = default;
    StopFlag(StopFlag&&) = default;
    StopFlag& operator=(StopFlag&&) = delete;
    ~StopFlag() {
      if (raised_) *raised_ = true;
    }
    std::shared_ptr<const std::atomic<bool>> watch() const { return raised_; }

   private:
    std::shared_ptr<std::atomic<bool>> raised_ = std::make_shared<std::atomic<bool>>(false);
  };
  struct MountingRun {
    MountingCalibration calibration;
    std::unique_ptr<Assembler> assembler;
    std::deque<SweepFit> fits = {};  // under way, beside what comes in: their end is waited for,
    StopFlag stop_fits = {};         // and comes soon, since this goes first
  };
  struct Run {
    std::variant<AlphaRun, MountingRun> kind;
    std::uint64_t request_id = 0;
    std::size_t wanted = 0;
    std::size_t left_out = 0;
    std::set<std::uint64_t> sweeps = {};  // of our request
    std::set<std::uint64_t> done = {};
  };

  std::variant<AlphaRun, MountingRun> begin(const msg::CalibrationRequest& request);
  void take(AssembledSweep&& assembled);
  void collect_fits(MountingRun& mounting);
  std::string why_not_taken(const msg::CalibrationRequest& request) const;
  void match(AlphaRun& alpha);
  void leave_out(std::uint64_t sweep_id, const std::string& why);
  void count(std::uint64_t sweep_id, const std::string& words);
  void finish();
  void refuse(const std::string& why);
  void tell(msg::CalibrationState state, const std::string& words);

  RigFile rig_;  // as drawn
  Outputs outputs_;
  SweepRequester requester_;
  CalibrationInUse known_;
  LidarName lidar_;
  std::optional<Run> run_;
  std::uint64_t last_request_id_ = 0;
  OrganisedCloud cloud_;  // the last one, and its stamp
  std::optional<std::int64_t> cloud_stamp_ns_;
  std::uint64_t clouds_refused_ = 0;
  bool news_ = false;
  std::chrono::steady_clock::time_point last_news_{};
};

}  // namespace swivel
