#include "components/swivel/live/calibrate_live.hpp"

#include <iostream>
#include <optional>
#include <utility>

#include "components/common/sweep_requester.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

constexpr auto kAnswer = std::chrono::seconds(10);
constexpr auto kSilenceOfACalibration =
    std::chrono::seconds(150);  // the calibrator itself gives up at 120

}  // namespace

LiveCalibration::LiveCalibration(Participant& participant)
    : requests_(participant, kCalibrationRequestTopic) {
  participant.subscribe<msg::CalibrationProgress>(kCalibrationProgressTopic,
                                                  [this](const msg::CalibrationProgress& step) {
                                                    const std::lock_guard lock(mutex_);
                                                    progress_.push_back(step);
                                                    came_.notify_all();
                                                  });
}

msg::CalibrationRequest calibration_request(msg::CalibrationKind kind, int mode, int count) {
  msg::CalibrationRequest request;
  request.kind(kind);
  request.mode(static_cast<std::uint8_t>(mode));
  request.count(static_cast<std::uint16_t>(count));
  return request;
}

void LiveCalibration::run(msg::CalibrationRequest request, StopSignal& stop) {
  request.request_id(new_request_id());
  bool answered = false;
  auto last_news = steady_clock::now();
  while (!stop.received()) {
    if (!answered) requests_.write(request);  // repeated: the topic is volatile
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::milliseconds(500), [&] { return !progress_.empty(); });
    const auto news = std::exchange(progress_, {});
    lock.unlock();
    for (const msg::CalibrationProgress& step : news) {
      if (step.request_id() != request.request_id()) continue;
      answered = true;
      last_news = steady_clock::now();
      if (step.state() == msg::CALIBRATION_REFUSED)
        throw ExitError(kExitBadData, "no calibration: " + step.words());
      std::cout << step.sweeps_used() << " of " << step.sweeps_wanted()
                << " sweeps: " << step.words() << std::endl;
      if (step.state() == msg::CALIBRATION_DONE) return;
    }
    if (steady_clock::now() - last_news > (answered ? kSilenceOfACalibration : kAnswer)) {
      throw ExitError(kExitUnavailable, "alpha_calibrator does not answer; see: swivel status");
    }
  }
  throw ExitError(kExitTryAgain, "stopped; alpha_calibrator finishes what it began");
}

}  // namespace swivel
