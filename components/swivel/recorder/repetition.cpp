#include "components/swivel/recorder/repetition.hpp"

#include <algorithm>
#include <utility>

namespace swivel {
namespace {

constexpr std::uint64_t kPause_ns = 100'000'000;  // from round to round

}  // namespace

void Repetition::note(std::int64_t time_ns) {
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
}

// A damaged recording may say any time, hence numbers that wrap around.
std::int64_t Repetition::later(std::int64_t time_ns) const {
  const std::uint64_t round_ns =
      static_cast<std::uint64_t>(last_ns_) - static_cast<std::uint64_t>(first_ns_) + kPause_ns;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) + (round_ - 1) * round_ns);
}

void Repetition::note_times(const msg::ScanLine& line) {
  note(line.beam0_time_ns());
  note(line.arrival_time_ns());
}

void Repetition::note_times(const msg::Axis& axis) {
  for (const msg::AxisSample& sample : axis.samples()) note(sample.time_ns());
}

void Repetition::note_times(const msg::Sweep& sweep) {
  note(sweep.time_ns());
  last_sweep_ = std::max(last_sweep_, sweep.sweep_id());
  if (sweep.phase() != msg::PHASE_CRUISING) return;
  note(sweep.window_start_ns());
  note(sweep.window_end_ns());
}

void Repetition::shift(msg::ScanLine& line) const {
  line.beam0_time_ns(later(line.beam0_time_ns()));
  line.arrival_time_ns(later(line.arrival_time_ns()));
}

void Repetition::shift(msg::Axis& axis) const {
  for (msg::AxisSample& sample : axis.samples()) sample.time_ns(later(sample.time_ns()));
}

void Repetition::shift(msg::Sweep& sweep) const {
  sweep.time_ns(later(sweep.time_ns()));
  sweep.window_start_ns(later(sweep.window_start_ns()));
  sweep.window_end_ns(later(sweep.window_end_ns()));
  if (sweep.sweep_id() != 0) sweep.sweep_id(sweep.sweep_id() + (round_ - 1) * last_sweep_);
}

template <class Message>
void Repetition::treat(ReplayMessage& message) {
  auto decoded = decode_cdr<Message>(message.cdr);
  if (!decoded) return;
  std::uint64_t& last_number = last_numbers_[message.topic->name];
  if (round_ <= 1) {
    note_times(*decoded);
    last_number = std::max(last_number, decoded->sequence_number());
    return;
  }
  shift(*decoded);
  decoded->sequence_number(decoded->sequence_number() + (round_ - 1) * last_number);
  message.cdr = encode_cdr(*decoded);
}

ReplayMessage Repetition::next(ReplayMessage message) {
  if (message.topic->is(kScanLineTopic)) treat<msg::ScanLine>(message);
  if (message.topic->is(kAxisTopic)) treat<msg::Axis>(message);
  if (message.topic->is(kSweepTopic)) treat<msg::Sweep>(message);
  return message;
}

}  // namespace swivel
