#include "components/alpha_calibrator/calibrator.hpp"

#include <cmath>

#include "components/common/cloud_message.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

// The longest that a whole sweep of any mode and its way through the pipeline take.
constexpr auto kPatience = std::chrono::seconds(120);
constexpr std::size_t kMostWaiting = 16;

}  // namespace

Calibrator::Calibrator(const RigFile& rig, Outputs outputs)
    : rig_(rig), outputs_(std::move(outputs)), requester_(outputs_.request_sweeps) {}

void Calibrator::take(const msg::CalibrationRequest& request) {
  const bool repeated = request.request_id() != 0 && request.request_id() == last_request_id_;
  if (repeated) return;  // as it is until it is answered
  const std::string wrong = why_not_taken(request);
  if (!wrong.empty()) {
    msg::CalibrationProgress refusal;
    refusal.request_id(request.request_id());
    refusal.state(msg::CALIBRATION_REFUSED);
    refusal.words(wrong);
    return outputs_.tell(refusal);
  }
  last_request_id_ = request.request_id();
  run_.emplace(Run{AlphaCalibration(rig_, {request.room_yaw_deg()}),
                   request.request_id(),
                   request.count(),
                   0,
                   {},
                   {},
                   {}});
  news_ = true;
  tell(msg::CALIBRATION_COLLECTING, "asking for " + std::to_string(request.count()) +
                                        " sweeps of mode " + std::to_string(request.mode()));
  requester_.request(request.request_id(), request.mode(), request.count());
}

std::string Calibrator::why_not_taken(const msg::CalibrationRequest& request) const {
  if (run_) return "busy with another calibration; try again when it is done";
  if (request.request_id() == 0) return "the request has no id; choose one that is not 0";
  if (request.count() == 0) return "no sweep is asked for; ask for some, 3 at least";
  if (!rig_.plate) return "rig " + rig_.rig + " has no plate, so there is no alpha to calibrate";
  if (!std::isfinite(request.room_yaw_deg())) return "the room's yaw is not a number";
  return {};
}

void Calibrator::take(const msg::Sweep& sweep) {
  if (!run_ || !requester_.saw(sweep)) return;
  news_ = true;
  if (sweep.phase() == msg::PHASE_REFUSED) return refuse("no sweep: " + sweep.reason());
  if (sweep.phase() == msg::PHASE_FAULT) return refuse("motor fault: " + sweep.reason());
  if (sweep.phase() == msg::PHASE_IDLE && !sweep.reason().empty()) {
    return refuse("the sweeps ended early: " + sweep.reason());
  }
  if (sweep.sweep_id() != 0) run_->sweeps.insert(sweep.sweep_id());
  if (sweep.phase() == msg::PHASE_ASSEMBLED && sweep.lines_used() == 0) {
    leave_out(sweep.sweep_id(), sweep.reason());
  }
}

void Calibrator::take(const msg::Attitude& attitude) {
  if (!run_) return;
  run_->attitudes[attitude.first_beam_time_ns()] = attitude;
  if (run_->attitudes.size() > kMostWaiting) run_->attitudes.erase(run_->attitudes.begin());
  match();
}

void Calibrator::take(const PointCloud2Message& raw_cloud) {
  if (!run_) return;
  cloud_stamp_ns_.reset();
  if (!from_message(raw_cloud, cloud_).empty()) return;
  cloud_stamp_ns_ = stamp_ns(raw_cloud);
  match();
}

void Calibrator::match() {
  if (!cloud_stamp_ns_) return;
  const auto found = run_->attitudes.find(*cloud_stamp_ns_);
  if (found == run_->attitudes.end()) return;
  const msg::Attitude attitude = found->second;
  run_->attitudes.erase(run_->attitudes.begin(), std::next(found));
  if (run_->sweeps.count(attitude.sweep_id()) == 0) return;
  if (run_->done.count(attitude.sweep_id()) != 0) return;
  const AlphaCalibration::Added added = run_->calibration.add(attitude, cloud_);
  if (!added.used) return leave_out(attitude.sweep_id(), added.words);
  count(attitude.sweep_id(), added.words);
}

void Calibrator::leave_out(std::uint64_t sweep_id, const std::string& why) {
  if (run_->done.count(sweep_id) != 0) return;
  ++run_->left_out;
  count(sweep_id, "left out: " + why);
}

void Calibrator::count(std::uint64_t sweep_id, const std::string& words) {
  if (!run_->done.insert(sweep_id).second) return;
  news_ = true;
  tell(msg::CALIBRATION_COLLECTING, words);
  if (run_->done.size() >= run_->wanted) finish();
}

void Calibrator::finish() {
  const AlphaCalibration::Outcome outcome = run_->calibration.fit(lidar_, now_ns());
  if (!outcome.calibration) return refuse(outcome.words);
  outputs_.publish(*outcome.calibration);
  tell(msg::CALIBRATION_DONE, outcome.words);
  run_.reset();
}

void Calibrator::check(std::chrono::steady_clock::time_point now) {
  if (!run_) return;
  if (news_) last_news_ = now;
  news_ = false;
  if (!requester_.check(now)) {
    refuse("stepper_sequencer does not answer; does it run? see: swivel status");
  } else if (now - last_news_ > kPatience) {
    requester_.cancel();
    refuse("no sweep for 2 minutes; see: swivel status");
  }
}

// A cancel stops whatever is under way, so only who sees that his own request hangs sends one.
void Calibrator::refuse(const std::string& why) {
  tell(msg::CALIBRATION_REFUSED, why);
  run_.reset();
}

void Calibrator::tell(msg::CalibrationState state, const std::string& words) {
  msg::CalibrationProgress progress;
  progress.request_id(run_->request_id);
  progress.state(state);
  progress.sweeps_used(static_cast<std::uint16_t>(run_->calibration.sweeps_used()));
  progress.sweeps_left_out(static_cast<std::uint16_t>(run_->left_out));
  progress.sweeps_wanted(static_cast<std::uint16_t>(run_->wanted));
  progress.words(words);
  outputs_.tell(progress);
}

}  // namespace swivel
