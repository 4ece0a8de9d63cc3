// The half of the sequencer that other threads see.
#include <chrono>
#include <utility>

#include "components/stepper_sequencer/sequencer.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {

void Sequencer::request(const msg::SweepRequest& request) {
  if (request.cancel()) {
    if (!cancel()) announcer_.repeat("there is nothing to cancel");
    return;
  }
  std::unique_lock lock(mutex_);
  const std::optional<std::string> reason = why_not_taken(request);
  if (!reason) {
    pending_ = request;
    busy_ = true;
    interruption_.clear_cancel();
    request_came_.notify_all();
    return;
  }
  lock.unlock();
  refuse(request, *reason);
}

bool Sequencer::cancel() {
  const std::lock_guard lock(mutex_);
  if (busy_) interruption_.cancel();
  return busy_;
}

std::optional<std::string> Sequencer::why_not_taken(const msg::SweepRequest& request) const {
  if (request.rig() != options_.rig) return "this is rig " + options_.rig;
  if (request.request_id() == 0) return "the request has no id (0); choose one";
  if (request.count() == 0) return "the request asks for 0 sweeps";
  if (!health_.ready) return "not ready: " + health_.doing;
  if (busy_) return "busy: " + health_.doing;
  return std::nullopt;
}

std::optional<msg::SweepRequest> Sequencer::await_request() {
  const std::chrono::duration<double> interval(options_.watch_interval_s);
  std::unique_lock lock(mutex_);
  request_came_.wait_for(lock, interval, [this] { return pending_ || interruption_.stopping(); });
  return std::exchange(pending_, std::nullopt);
}

void Sequencer::refuse(const msg::SweepRequest& request, const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    ++health_.requests_refused;
  }
  announcer_.refuse(request, reason);
}

// The request under way is over; one that was queued when a fault came goes with it.
void Sequencer::release(const std::string& why_queued_is_refused) {
  std::optional<msg::SweepRequest> dropped;
  {
    const std::lock_guard lock(mutex_);
    dropped = std::exchange(pending_, std::nullopt);
    busy_ = false;
    interruption_.clear_cancel();
  }
  if (dropped) refuse(*dropped, why_queued_is_refused);
}

void Sequencer::doing(const std::string& words, bool ready) {
  const std::lock_guard lock(mutex_);
  health_.doing = words;
  health_.ready = ready;
  health_.garbage_lines = stepper_.garbage_lines();
}

void Sequencer::note_controller() {
  const std::lock_guard lock(mutex_);
  health_.firmware = stepper_.firmware();
  health_.advice = stepper_.settings().advice;
}

void Sequencer::note_error(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++health_.faults;
  health_.last_error = reason;
  health_.last_error_time_ns = now_ns();
}

SequencerHealth Sequencer::health() const {
  const std::lock_guard lock(mutex_);
  SequencerHealth health = health_;
  health.positions_left_out = announcer_.positions_left_out();
  return health;
}

}  // namespace swivel
