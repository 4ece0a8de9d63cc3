#include "components/swivel/live/live_sweeps.hpp"

#include <fmt/core.h>

#include "components/common/cloud_message.hpp"
#include "components/common/phase_word.hpp"
#include "components/log/log.hpp"

namespace swivel {
namespace {

// Of sweeps that are not whole yet. Others' sweeps and clouds come by as well, of 11 MB and more.
constexpr std::size_t kMostWaiting = 8;

std::string in_words(const msg::Sweep& sweep) {
  if (sweep.phase() != msg::PHASE_CRUISING) return phase_word(sweep.phase());
  if (sweep.window_lines() == 1)
    return fmt::format("line {} of {}", sweep.window_first_line() + 1, sweep.lines_expected());
  const double window_ns =
      static_cast<double>(sweep.window_end_ns()) - static_cast<double>(sweep.window_start_ns());
  return fmt::format("scanning, {:.1f} s", window_ns * 1e-9);
}

}  // namespace

LiveSweeps::LiveSweeps(Participant& participant)
    : requests_(participant, kSweepRequestTopic),
      requester_([this](const msg::SweepRequest& request) {
        requests_.write(msg::SweepRequest(request));
      }) {
  participant.subscribe<msg::Sweep>(kSweepTopic, [this](const auto& sweep) { take(sweep); });
  participant.subscribe<msg::Attitude>(kAttitudeTopic, [this](const msg::Attitude& attitude) {
    const std::lock_guard lock(mutex_);
    Parts& parts = parts_at(attitude.first_beam_time_ns());
    parts.sweep.attitude = attitude;
    parts.attitude = true;
    hand_out_if_whole(attitude.first_beam_time_ns());
  });
  participant.subscribe<PointCloud2>(
      kRawCloudTopic, [this](const auto& cloud) { take_cloud(cloud, &ProcessedSweep::raw); });
  participant.subscribe<PointCloud2>(
      kCloudTopic, [this](const auto& cloud) { take_cloud(cloud, &ProcessedSweep::cloud); });
  participant.on_tick(std::chrono::seconds(1), [this] {
    const std::lock_guard lock(mutex_);
    if (!requester_.check(std::chrono::steady_clock::now())) {
      tell({{}, {}, "stepper_sequencer does not answer; does it run? see: swivel status"});
    }
  });
}

void LiveSweeps::follow_all() {
  const std::lock_guard lock(mutex_);
  follows_all_ = true;
}

bool LiveSweeps::await_idle(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return came_.wait_for(lock, timeout, [this] { return idle_; });
}

void LiveSweeps::request(int mode, int count, msg::SweepSequence action_sequence) {
  const std::lock_guard lock(mutex_);
  requester_.request(new_request_id(), mode, count, action_sequence);
}

void LiveSweeps::cancel() {
  const std::lock_guard lock(mutex_);
  requester_.cancel();
}

void LiveSweeps::take(const msg::Sweep& sweep) {
  const std::lock_guard lock(mutex_);
  if (sweep.phase() != msg::PHASE_REFUSED && sweep.phase() != msg::PHASE_ASSEMBLED) {
    idle_ = sweep.phase() == msg::PHASE_IDLE;
    came_.notify_all();
  }
  if (follows_all_ && sweep.phase() == msg::PHASE_ASSEMBLED) return take_assembled(sweep);
  if (!requester_.saw(sweep)) return;
  if (sweep.phase() == msg::PHASE_REFUSED) return tell({{}, {}, sweep.reason()});
  if (sweep.phase() == msg::PHASE_FAULT) return tell({{}, {}, "motor fault: " + sweep.reason()});
  if (sweep.phase() == msg::PHASE_ASSEMBLED) return take_assembled(sweep);
  tell({{}, in_words(sweep), {}});
}

void LiveSweeps::take_assembled(const msg::Sweep& sweep) {
  if (sweep.lines_used() == 0) {
    ProcessedSweep nothing;
    nothing.index = next_index_++;
    nothing.sweep = sweep;
    nothing.attitude.mode(sweep.mode());
    nothing.attitude.verdict(msg::VERDICT_LINES_MISSING);
    return tell({std::move(nothing), {}, {}});
  }
  Parts& parts = parts_at(sweep.first_beam_time_ns());
  parts.sweep.sweep = sweep;
  parts.assembled = true;
  hand_out_if_whole(sweep.first_beam_time_ns());
}

void LiveSweeps::take_cloud(const PointCloud2& message, OrganisedCloud ProcessedSweep::*cloud) {
  const std::lock_guard lock(mutex_);
  OrganisedCloud taken;
  const std::string wrong = from_message(message, taken);
  if (!wrong.empty()) return log_warning("a cloud was refused: {}", wrong);
  parts_at(stamp_ns(message)).sweep.*cloud = std::move(taken);
  hand_out_if_whole(stamp_ns(message));
}

LiveSweeps::Parts& LiveSweeps::parts_at(std::int64_t stamp_ns) {
  const bool full = parts_.size() >= kMostWaiting && parts_.count(stamp_ns) == 0;
  if (full) parts_.erase(parts_.begin());
  return parts_[stamp_ns];
}

void LiveSweeps::hand_out_if_whole(std::int64_t stamp_ns) {
  Parts& parts = parts_at(stamp_ns);
  const bool whole = parts.assembled && parts.attitude && !parts.sweep.raw.points.empty() &&
                     !parts.sweep.cloud.points.empty();
  if (!whole) return;
  parts.sweep.index = next_index_++;
  tell({std::move(parts.sweep), {}, {}});
  parts_.erase(parts_.begin(), parts_.upper_bound(stamp_ns));  // older ones are not ours
}

void LiveSweeps::tell(News news) {
  news_.push_back(std::move(news));
  came_.notify_all();
}

std::optional<LiveSweeps::News> LiveSweeps::wait(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, timeout, [this] { return !news_.empty(); })) return std::nullopt;
  News news = std::move(news_.front());
  news_.pop_front();
  return news;
}

}  // namespace swivel
