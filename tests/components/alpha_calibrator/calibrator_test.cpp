#include "components/alpha_calibrator/calibrator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "components/common/calibration_file.hpp"
#include "components/common/cloud_message.hpp"

namespace swivel {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

constexpr double kAlphaDeg = 29.36;
constexpr std::int64_t kStampNs = 1'700'000'000'000'000'000;

// How far along a direction a room of four walls, floor and roof ends.
double reach_m(const Eigen::Vector3d& ray) {
  const double x_m = (ray.x() > 0 ? 3.0 : -4.0) / ray.x();
  const double y_m = (ray.y() > 0 ? 2.0 : -2.5) / ray.y();
  const double z_m = (ray.z() > 0 ? 1.8 : -0.9) / ray.z();
  return std::min({x_m, y_m, z_m});
}

// The room as a sweep sees it that starts phi_offset from the front.
OrganisedCloud room_cloud(double phi_offset_deg, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> any(0.0, 1.0);
  const Eigen::AngleAxisd turn(rad_from_deg(-phi_offset_deg), Eigen::Vector3d::UnitZ());
  OrganisedCloud cloud(60, 400);
  for (CloudPoint& point : cloud.points) {
    const Eigen::Vector3d ray = Eigen::Vector3d(any(random), any(random), any(random)).normalized();
    const Eigen::Vector3f seen = (turn * (ray * (reach_m(ray) + 0.01 * any(random)))).cast<float>();
    point = {seen.x(), seen.y(), seen.z(), 1.0F};
  }
  return cloud;
}

RigFile rig_with_plate() {
  RigFile rig;
  rig.rig = "swivel";
  rig.plate = PlateGeometry();
  return rig;
}

class CalibratorRun : public testing::Test {
 protected:
  CalibratorRun()
      : calibrator_(rig_with_plate(),
                    {[this](const auto& request) { requests_.push_back(request); },
                     [this](const auto& progress) { told_.push_back(progress); },
                     [this](const auto& calibration) { published_.push_back(calibration); }}) {
    calibrator_.name_lidar({"H123", "3.02"});
  }

  void ask(std::uint64_t id, std::uint16_t count, double room_yaw_deg = 0.0) {
    msg::CalibrationRequest request;
    request.request_id(id);
    request.mode(7);
    request.count(count);
    request.room_yaw_deg(room_yaw_deg);
    calibrator_.take(request);
  }

  msg::Sweep sweep(std::uint64_t id, msg::SweepPhase phase, const std::string& reason = "") {
    msg::Sweep sweep;
    sweep.request_id(requests_.empty() ? 0 : requests_.back().request_id());
    sweep.sweep_id(id);
    sweep.phase(phase);
    sweep.lines_used(60);
    sweep.reason(reason);
    return sweep;
  }

  msg::Attitude attitude(std::uint64_t id, double phi_offset_deg) {
    msg::Attitude attitude;
    attitude.sweep_id(id);
    attitude.first_beam_time_ns(kStampNs + static_cast<std::int64_t>(id));
    attitude.mode(7);
    attitude.verdict(msg::VERDICT_GOOD);
    attitude.estimator("ring_mean");
    attitude.beta_deg(kAlphaDeg - phi_offset_deg);
    attitude.beta_sigma_deg(0.1);
    return attitude;
  }

  PointCloud2Message raw(std::uint64_t id, const OrganisedCloud& cloud) {
    PointCloud2Message message;
    to_message(cloud, kStampNs + static_cast<std::int64_t>(id), "swivel/start", message);
    return message;
  }

  void sweep_the_room(std::uint64_t id, double phi_offset_deg) {
    calibrator_.take(sweep(id, msg::PHASE_CRUISING));
    const PointCloud2Message cloud = raw(id, room_cloud(phi_offset_deg, static_cast<unsigned>(id)));
    if (id % 2 == 0) calibrator_.take(cloud);
    calibrator_.take(attitude(id, phi_offset_deg));
    if (id % 2 == 1) calibrator_.take(cloud);
  }

  void expect_refused(const std::string& words) {
    ASSERT_FALSE(told_.empty());
    EXPECT_EQ(told_.back().state(), msg::CALIBRATION_REFUSED);
    EXPECT_THAT(told_.back().words(), HasSubstr(words));
    EXPECT_TRUE(published_.empty());
  }

  long cancels() const {
    return std::count_if(requests_.begin(), requests_.end(),
                         [](const msg::SweepRequest& request) { return request.cancel(); });
  }

  std::vector<msg::SweepRequest> requests_;
  std::vector<msg::CalibrationProgress> told_;
  std::vector<msg::Calibration> published_;
  Calibrator calibrator_;
  std::chrono::steady_clock::time_point now_{std::chrono::hours(1)};
};

TEST_F(CalibratorRun, FindsAlphaInARoom) {
  ask(5, 4);
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].count(), 4);
  EXPECT_EQ(requests_[0].mode(), 7);
  sweep_the_room(101, 1.2);
  sweep_the_room(102, -3.4);
  sweep_the_room(103, 4.9);
  EXPECT_TRUE(published_.empty());
  EXPECT_EQ(told_.back().state(), msg::CALIBRATION_COLLECTING);
  EXPECT_EQ(told_.back().sweeps_used(), 3);
  sweep_the_room(104, 0.3);
  ASSERT_EQ(published_.size(), 1U) << told_.back().words();
  const msg::Calibration& calibration = published_[0];
  EXPECT_NEAR(calibration.alpha_deg(), kAlphaDeg, 0.1);
  EXPECT_LT(std::abs(calibration.alpha_deg() - kAlphaDeg), 4.0 * alpha_sigma_deg(calibration));
  EXPECT_EQ(calibration.rig().to_string(), "swivel");
  EXPECT_EQ(calibration.sweeps_used(), 4U);
  EXPECT_EQ(calibration.serial_number(), "H123");
  EXPECT_EQ(calibration.firmware(), "3.02");
  EXPECT_EQ(told_.back().state(), msg::CALIBRATION_DONE);
  EXPECT_EQ(told_.back().request_id(), 5U);
  EXPECT_FALSE(calibrator_.running());
  EXPECT_EQ(cancels(), 0);
}

TEST_F(CalibratorRun, ARepeatedRequestIsOneRun) {
  ask(5, 3);
  ask(5, 3);
  EXPECT_EQ(requests_.size(), 1U);
  EXPECT_EQ(told_.size(), 1U);
  for (std::uint64_t id = 101; id <= 103; ++id) sweep_the_room(id, static_cast<double>(id) - 102.0);
  ASSERT_EQ(published_.size(), 1U);
  ask(5, 3);
  EXPECT_EQ(requests_.size(), 1U);
}

TEST_F(CalibratorRun, ASweepToldTwiceCountsOnce) {
  ask(5, 3);
  sweep_the_room(101, 1.0);
  sweep_the_room(101, 1.0);
  sweep_the_room(101, 1.0);
  EXPECT_TRUE(calibrator_.running());
  EXPECT_EQ(told_.back().sweeps_used(), 1);
}

TEST_F(CalibratorRun, SweepsOfOthersAreNotTaken) {
  ask(5, 3);
  msg::Sweep other = sweep(101, msg::PHASE_CRUISING);
  other.request_id(99);
  calibrator_.take(other);
  calibrator_.take(attitude(101, 1.0));
  calibrator_.take(raw(101, room_cloud(1.0, 1)));
  EXPECT_EQ(told_.size(), 1U);
}

TEST_F(CalibratorRun, BadSweepsAreLeftOutWithAReason) {
  ask(5, 4);
  calibrator_.take(sweep(101, msg::PHASE_CRUISING));
  msg::Attitude blind = attitude(101, 0.0);
  blind.verdict(msg::VERDICT_NO_PLATE);
  blind.reason("nothing in the ring");
  calibrator_.take(blind);
  calibrator_.take(raw(101, room_cloud(0.0, 1)));
  EXPECT_THAT(told_.back().words(), HasSubstr("nothing in the ring"));
  calibrator_.take(sweep(102, msg::PHASE_CRUISING));
  msg::Sweep faulty = sweep(102, msg::PHASE_ASSEMBLED, "no line at all");
  faulty.lines_used(0);
  calibrator_.take(faulty);
  EXPECT_THAT(told_.back().words(), HasSubstr("no line at all"));
  EXPECT_EQ(told_.back().sweeps_left_out(), 2);
  sweep_the_room(103, 1.0);
  sweep_the_room(104, -1.0);
  expect_refused("");  // two are too few
  EXPECT_FALSE(calibrator_.running());
}

TEST_F(CalibratorRun, RequestsThatMeanNothingAreRefused) {
  ask(5, 0);
  expect_refused("no sweep is asked for");
  ask(0, 3);
  expect_refused("no id");
  ask(6, 3, std::numeric_limits<double>::quiet_NaN());
  expect_refused("yaw");
  EXPECT_TRUE(requests_.empty());
  EXPECT_FALSE(calibrator_.running());
}

TEST_F(CalibratorRun, AfterARefusalTheNextRequestWorks) {
  ask(5, 0);
  ask(6, 3);
  calibrator_.take(sweep(0, msg::PHASE_REFUSED, "busy"));
  expect_refused("no sweep: busy");
  ask(7, 3);
  for (std::uint64_t id = 101; id <= 103; ++id) sweep_the_room(id, static_cast<double>(id) - 102.0);
  EXPECT_EQ(published_.size(), 1U);
}

TEST_F(CalibratorRun, BusyIsSaidAndTheRunGoesOn) {
  ask(5, 3);
  ask(6, 3);
  expect_refused("busy");
  EXPECT_EQ(told_.back().request_id(), 6U);
  for (std::uint64_t id = 101; id <= 103; ++id) sweep_the_room(id, static_cast<double>(id) - 102.0);
  EXPECT_EQ(published_.size(), 1U);
}

// A cancel would stop the sweeps of whoever the sequencer is busy with.
TEST_F(CalibratorRun, ARefusedRequestCancelsNobodysSweeps) {
  ask(5, 3);
  calibrator_.take(sweep(0, msg::PHASE_REFUSED, "busy with another request"));
  expect_refused("busy with another request");
  EXPECT_EQ(cancels(), 0);
}

TEST_F(CalibratorRun, AFaultEndsIt) {
  ask(5, 3);
  sweep_the_room(101, 1.0);
  calibrator_.take(sweep(102, msg::PHASE_FAULT, "ALARM:1"));
  expect_refused("ALARM:1");
  EXPECT_FALSE(calibrator_.running());
}

TEST_F(CalibratorRun, SweepsThatOthersCancelledEndIt) {
  ask(5, 3);
  sweep_the_room(101, 1.0);
  calibrator_.take(sweep(102, msg::PHASE_IDLE, "cancelled"));
  expect_refused("cancelled");
}

TEST_F(CalibratorRun, ASilentSequencerIsNamedAfterTenSeconds) {
  ask(5, 3);
  for (int second = 0; second < 10; ++second) calibrator_.check(now_ + seconds(second));
  EXPECT_TRUE(calibrator_.running());
  EXPECT_EQ(requests_.size(), 11U);  // asked again each time: it may have started late
  calibrator_.check(now_ + seconds(10));
  expect_refused("stepper_sequencer does not answer");
}

TEST_F(CalibratorRun, ASweepThatNeverEndsIsGivenUpAndStopped) {
  ask(5, 3);
  calibrator_.take(sweep(101, msg::PHASE_CRUISING));
  calibrator_.check(now_);
  calibrator_.check(now_ + seconds(119));
  EXPECT_TRUE(calibrator_.running());
  calibrator_.check(now_ + seconds(121));
  expect_refused("2 minutes");
  EXPECT_EQ(cancels(), 1);
}

TEST_F(CalibratorRun, WithoutWallsThereIsNoAlpha) {
  ask(5, 3);
  for (std::uint64_t id = 101; id <= 103; ++id) {
    calibrator_.take(sweep(id, msg::PHASE_CRUISING));
    calibrator_.take(attitude(id, 1.0));
    calibrator_.take(raw(id, OrganisedCloud(60, 400)));
  }
  expect_refused("wall");
  EXPECT_EQ(cancels(), 0);
}

// An attitude without a stamp must not meet a cloud that was refused.
TEST_F(CalibratorRun, ARefusedCloudIsNoCloud) {
  ask(5, 3);
  calibrator_.take(sweep(101, msg::PHASE_CRUISING));
  PointCloud2Message broken = raw(101, room_cloud(1.0, 1));
  broken.data().resize(3);
  calibrator_.take(broken);
  msg::Attitude unstamped = attitude(101, 1.0);
  unstamped.first_beam_time_ns(0);
  calibrator_.take(unstamped);
  calibrator_.take(attitude(101, 1.0));
  EXPECT_EQ(told_.size(), 1U);
}

}  // namespace
}  // namespace swivel
