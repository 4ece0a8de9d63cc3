// A calibration by a live rig's alpha_calibrator.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>

#include "components/common/program.hpp"
#include "components/dds/participant.hpp"

namespace swivel {

msg::CalibrationRequest calibration_request(msg::CalibrationKind kind, int mode, int count);

class LiveCalibration {
 public:
  // Subscribes: before participant.start().
  explicit LiveCalibration(Participant& participant);

  // Requests it, under a new id, and tells how it goes on stdout. Throws ExitError with the reason
  // of a refusal.
  void run(msg::CalibrationRequest request, StopSignal& stop);

 private:
  Writer<msg::CalibrationRequest> requests_;
  std::mutex mutex_;  // of what follows
  std::condition_variable came_;
  std::deque<msg::CalibrationProgress> progress_;
};

}  // namespace swivel
