#include "components/alpha_calibrator/calibrator.hpp"

#include <cmath>

#include "components/common/cloud_message.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

// The longest that a whole sweep of any mode and its way through the pipeline take.
constexpr auto kLongestSilence = std::chrono::seconds(120);
constexpr std::size_t kMostAttitudesWaiting = 16;

}  // namespace

Calibrator::Calibrator(const RigFile& rig, Outputs outputs)
    : rig_(rig),
      outputs_(std::move(outputs)),
      requester_(outputs_.request_sweeps),
      known_(rig.rig) {}

std::string Calibrator::name_lidar(const LidarName& lidar) {
  lidar_ = lidar;
  return known_.name_lidar(lidar.serial_number);
}

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
  run_.emplace(Run{begin(request), request.request_id(), request.count()});
  news_ = true;
  tell(msg::CALIBRATION_COLLECTING, "asking for " + std::to_string(request.count()) +
                                        " sweeps of mode " + std::to_string(request.mode()));
  requester_.request(request.request_id(), request.mode(), request.count());
}

std::variant<Calibrator::AlphaRun, Calibrator::MountingRun> Calibrator::begin(
    const msg::CalibrationRequest& request) {
  if (request.kind() == msg::CALIBRATION_OF_ALPHA) {
    RigFile rig = rig_;  // the raw clouds are made with the mounting that is known
    if (known_.now()) rig.geometry = calibrated_geometry(rig_.geometry, *known_.now());
    return AlphaRun{AlphaCalibration(rig, {request.room_yaw_deg()}), {}};
  }
  AssemblyOptions options{rig_.geometry, rig_.axis_measured, rig_.timing,
                          rad_from_deg(rig_.modes.sweep_angle_deg), true};
  return MountingRun{MountingCalibration(rig_),
                     std::make_unique<Assembler>(
                         options, [this](AssembledSweep&& sweep) { take(std::move(sweep)); })};
}

std::string Calibrator::why_not_taken(const msg::CalibrationRequest& request) const {
  if (run_) return "busy with another calibration; try again when it is done";
  if (request.request_id() == 0) return "the request has no id; choose one that is not 0";
  if (request.count() == 0) return "no sweep is asked for; ask for some, 3 at least";
  const bool alpha = request.kind() == msg::CALIBRATION_OF_ALPHA;
  if (!alpha && request.kind() != msg::CALIBRATION_OF_MOUNTING) return "no such calibration";
  if (alpha && !rig_.plate)
    return "rig " + rig_.rig + " has no plate, so there is no alpha to calibrate";
  if (!std::isfinite(request.room_yaw_deg())) return "the room's yaw is not a number";
  return {};
}

void Calibrator::take(const msg::Sweep& sweep) {
  if (!run_) return;
  const bool ours = requester_.saw(sweep);
  if (ours && sweep.sweep_id() != 0) run_->sweeps.insert(sweep.sweep_id());
  if (auto* const mounting = std::get_if<MountingRun>(&run_->kind)) mounting->assembler->add(sweep);
  if (!ours) return;
  news_ = true;
  if (sweep.phase() == msg::PHASE_REFUSED) return refuse("no sweep: " + sweep.reason());
  if (sweep.phase() == msg::PHASE_FAULT) return refuse("motor fault: " + sweep.reason());
  if (sweep.phase() == msg::PHASE_IDLE && !sweep.reason().empty()) {
    return refuse("the sweeps ended early: " + sweep.reason());
  }
  if (sweep.phase() == msg::PHASE_ASSEMBLED && sweep.lines_used() == 0) {
    leave_out(sweep.sweep_id(), sweep.reason());
  }
}

void Calibrator::take(const msg::ScanLine& line) {
  auto* const mounting = run_ ? std::get_if<MountingRun>(&run_->kind) : nullptr;
  if (mounting != nullptr) mounting->assembler->add(line);
}

void Calibrator::take(const msg::Axis& axis) {
  auto* const mounting = run_ ? std::get_if<MountingRun>(&run_->kind) : nullptr;
  if (mounting != nullptr) mounting->assembler->add(axis);
}

// Fitted on another thread: it takes seconds, and the lines of the next sweep come in meanwhile.
// Told by the assembler, which must outlive this call: the outcome is looked at in check().
void Calibrator::take(AssembledSweep&& assembled) {
  const msg::Sweep& sweep = assembled.sweep;
  if (run_->sweeps.count(sweep.sweep_id()) == 0) return;
  auto& mounting = std::get<MountingRun>(run_->kind);
  std::future<MountingResult> result;
  if (sweep.complete()) {
    result = std::async(std::launch::async,
                        [readings = std::move(assembled.readings), geometry = rig_.geometry,
                         stop = mounting.stop_fits.watch()] {
                          return fit_mounting(readings, geometry, [&stop] { return stop->load(); });
                        });
  } else {
    std::promise<MountingResult> refusal;
    refusal.set_value({std::nullopt, sweep.reason()});
    result = refusal.get_future();
  }
  mounting.fits.push_back({sweep, std::move(result)});
}

void Calibrator::collect_fits(MountingRun& mounting) {
  while (!mounting.fits.empty() && mounting.fits.front().result.wait_for(std::chrono::seconds(0)) ==
                                       std::future_status::ready) {
    SweepFit fit = std::move(mounting.fits.front());
    mounting.fits.pop_front();
    const auto added = mounting.calibration.add(fit.sweep.mode(), fit.result.get());
    if (added.used) count(fit.sweep.sweep_id(), added.words);
    if (!added.used) leave_out(fit.sweep.sweep_id(), added.words);
    if (!run_) return;  // that was the last one
  }
}

void Calibrator::take(const msg::Attitude& attitude) {
  auto* const alpha = run_ ? std::get_if<AlphaRun>(&run_->kind) : nullptr;
  if (alpha == nullptr) return;
  alpha->attitudes[attitude.first_beam_time_ns()] = attitude;
  if (alpha->attitudes.size() > kMostAttitudesWaiting)
    alpha->attitudes.erase(alpha->attitudes.begin());
  match(*alpha);
}

void Calibrator::take(const PointCloud2Message& raw_cloud) {
  auto* const alpha = run_ ? std::get_if<AlphaRun>(&run_->kind) : nullptr;
  if (alpha == nullptr) return;
  cloud_stamp_ns_.reset();
  if (!from_message(raw_cloud, cloud_).empty()) {
    ++clouds_refused_;
    return;
  }
  cloud_stamp_ns_ = stamp_ns(raw_cloud);
  match(*alpha);
}

void Calibrator::match(AlphaRun& alpha) {
  if (!cloud_stamp_ns_) return;
  const auto found = alpha.attitudes.find(*cloud_stamp_ns_);
  if (found == alpha.attitudes.end()) return;
  const msg::Attitude attitude = found->second;
  alpha.attitudes.erase(alpha.attitudes.begin(), std::next(found));
  if (run_->sweeps.count(attitude.sweep_id()) == 0) return;
  if (run_->done.count(attitude.sweep_id()) != 0) return;
  const AlphaCalibration::Added added = alpha.calibration.add(attitude, cloud_);
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
  const CalibrationOutcome outcome = std::visit(
      [this](const auto& kind) { return kind.calibration.fit(lidar_, now_ns()); }, run_->kind);
  if (!outcome.calibration) return refuse(outcome.words);
  const msg::Calibration whole = completed(*outcome.calibration, known_.now());
  if (const std::string wrong = known_.take(whole); !wrong.empty()) return refuse(wrong);
  outputs_.publish(whole);
  tell(msg::CALIBRATION_DONE, outcome.words);
  run_.reset();
}

void Calibrator::check(std::chrono::steady_clock::time_point now) {
  if (!run_) return;
  if (auto* const mounting = std::get_if<MountingRun>(&run_->kind)) {
    mounting->assembler->check(now);
    collect_fits(*mounting);
    if (!run_) return;
    if (!mounting->fits.empty()) news_ = true;
  }
  if (news_) last_news_ = now;
  news_ = false;
  if (!requester_.check(now)) {
    refuse("stepper_sequencer does not answer; does it run? see: swivel status");
  } else if (now - last_news_ > kLongestSilence) {
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
  progress.sweeps_used(static_cast<std::uint16_t>(
      std::visit([](const auto& kind) { return kind.calibration.sweeps_used(); }, run_->kind)));
  progress.sweeps_left_out(static_cast<std::uint16_t>(run_->left_out));
  progress.sweeps_wanted(static_cast<std::uint16_t>(run_->wanted));
  progress.words(words);
  outputs_.tell(progress);
}

}  // namespace swivel
