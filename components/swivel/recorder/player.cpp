#include "components/swivel/recorder/player.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "components/log/log.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Less than the writer's history: what is not yet acknowledged must not be overwritten.
constexpr std::uint64_t kLinesUnacknowledged = 100;
constexpr auto kAcknowledged = milliseconds(5000);

bool await(const std::function<bool()>& done) {
  const auto deadline = steady_clock::now() + kAcknowledged;
  while (!done() && steady_clock::now() < deadline) std::this_thread::sleep_for(milliseconds(1));
  return done();
}

}  // namespace

Player::Player(Participant& participant, const std::vector<AnyTopic>& topics) {
  for (const AnyTopic& topic : topics) {
    outputs_[topic.name].writer = std::make_unique<CdrWriter>(participant, topic);
  }
  for (const AnyTopic& topic : all_topics()) {
    if (topic.is(kSweepTopic)) {
      participant.subscribe_cdr(topic, [this](CdrSample&& sample) {
        const auto sweep = decode_cdr<msg::Sweep>(sample.cdr);
        if (!sweep || sweep->phase() != msg::PHASE_ASSEMBLED) return;
        last_has_cloud_ = sweep->lines_used() > 0;
        last_assembled_ = sweep->sweep_id();
      });
    } else if (topic.is(kAttitudeTopic)) {
      participant.subscribe_cdr(topic, [this](CdrSample&& sample) {
        if (const auto attitude = decode_cdr<msg::Attitude>(sample.cdr)) {
          last_corrected_ = attitude->sweep_id();
        }
      });
    }
  }
}

std::size_t Player::readers_of(const std::string& topic) const {
  const auto output = outputs_.find(topic);
  if (output == outputs_.end()) return 0;
  const std::size_t own = topic == kSweepTopic.name || topic == kAttitudeTopic.name ? 1 : 0;
  return std::max(output->second.writer->reader_count(), own) - own;
}

bool Player::has_readers() const {
  if (outputs_.count(kScanLineTopic.name) == 1) {
    return readers_of(kScanLineTopic.name) > 0 && readers_of(kSweepTopic.name) > 0;
  }
  for (const AnyTopic& topic : all_topics()) {
    if (readers_of(topic.name) > 0) return true;
  }
  return false;
}

void Player::play(const ReplayMessage& message) {
  if (message.topic->is(kSweepTopic)) return play_sweep(message);
  send(message);
  if (!over_ || !message.topic->is(kScanLineTopic)) return;
  // The first line after the window of a sweep whose end is told: the stages have all they need.
  const auto line = decode_cdr<msg::ScanLine>(message.cdr);
  if (line && line->beam0_time_ns() > window_end_ns_) await_stages();
}

void Player::play_sweep(const ReplayMessage& message) {
  const auto sweep = decode_cdr<msg::Sweep>(message.cdr);
  const bool cruising = sweep && sweep->phase() == msg::PHASE_CRUISING;
  if (cruising && sweep->sweep_id() != sweep_) await_stages();
  send(message);
  if (cruising) {
    sweep_ = sweep->sweep_id();
    window_end_ns_ = sweep->window_end_ns();
  }
  over_ = over_ || (sweep_ != 0 && sweep && sweep->phase() == msg::PHASE_DECELERATING);
}

void Player::send(const ReplayMessage& message) {
  Output& output = outputs_.at(message.topic->name);
  if (!output.writer->write(message.cdr)) {
    if (++output.refused == 1) log_error("a message of {} is refused", message.topic->name);
    return;
  }
  const bool is_line = message.topic->is(kScanLineTopic);
  if (++output.written % kLinesUnacknowledged == 0 || !is_line) {
    output.writer->wait_until_acknowledged(kAcknowledged);
  }
}

// No faster than a sweep is assembled and corrected: stages that fall behind lose lines and clouds.
void Player::await_stages() {
  over_ = false;
  if (sweep_ == 0 || outputs_.count(kScanLineTopic.name) == 0) return;
  const std::uint64_t sweep = std::exchange(sweep_, 0);
  if (!await([&] { return last_assembled_ == sweep; })) {
    log_warning("sweep {} was not assembled within 5 s", sweep);
    return;
  }
  if (!has_corrector_ || !last_has_cloud_) return;
  has_corrector_ = await([&] { return last_corrected_ == sweep; });
  if (!has_corrector_) log_warning("no attitude came within 5 s: is there no corrector?");
}

void Player::finish() {
  for (const auto& [name, output] : outputs_) output.writer->wait_until_acknowledged(kAcknowledged);
  await_stages();
}

std::uint64_t Player::played() const {
  std::uint64_t sum = 0;
  for (const auto& [name, output] : outputs_) sum += output.written;
  return sum;
}

std::string Player::in_words() const {
  std::string words;
  for (const auto& [name, output] : outputs_) {
    if (output.written + output.refused == 0) continue;
    words += (words.empty() ? "" : ", ") + std::to_string(output.written) + " " + name;
    if (output.refused > 0) words += " (" + std::to_string(output.refused) + " refused)";
  }
  return words.empty() ? "nothing was in it to replay" : words + " replayed";
}

}  // namespace swivel
