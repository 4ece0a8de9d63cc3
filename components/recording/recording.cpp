#include "components/recording/recording.hpp"

#include <cmath>
#include <deque>
#include <filesystem>
#include <memory>
#include <utility>

#include "components/mcap/reader.hpp"
#include "components/recording/case_folder.hpp"
#include "components/recording/csv_recording.hpp"
#include "components/recording/mcap_recording.hpp"
#include "components/recording/recording_plan.hpp"

namespace swivel {

std::int64_t RecordingPlan::line_duration_ns() const {
  return std::llround(static_cast<double>(facts.beams - 1) * line.beam_period_ns());
}

namespace {

// Turns the plan into events, a line at a time.
class PlanPlayer {
 public:
  PlanPlayer(RecordingPlan plan, std::string rig) : plan_(std::move(plan)), rig_(std::move(rig)) {
    plan_.line.rig(rig_);
  }

  Result<std::optional<RecordedEvent>> next();

 private:
  Outcome play_line();
  void open_sweep(const RecordedSweep& sweep);
  void close_sweep(const RecordedSweep& sweep);
  void announce(const RecordedSweep& sweep, msg::SweepPhase phase, std::int64_t time_ns);
  void send_axis(msg::AxisSource source, std::vector<msg::AxisSample> samples,
                 std::int64_t time_ns);
  template <class Message>
  void send(Message message, std::int64_t time_ns);

  std::int64_t window_start_ns(const RecordedSweep& sweep) const;
  std::int64_t window_end_ns(const RecordedSweep& sweep) const;

  RecordingPlan plan_;
  std::string rig_;
  std::deque<RecordedEvent> events_;
  std::size_t line_ = 0;   // to be played next
  std::size_t sweep_ = 0;  // that is open, or opens next
  std::int64_t time_ns_ = INT64_MIN;
  std::uint64_t axes_sent_ = 0;
  std::uint64_t sweeps_sent_ = 0;
};

msg::AxisSample axis_sample(std::int64_t time_ns, double angle_deg) {
  msg::AxisSample sample;
  sample.time_ns(time_ns);
  sample.angle_deg(angle_deg);
  return sample;
}

// The line through two samples, given a hair's room at both ends.
std::vector<msg::AxisSample> turn(std::int64_t start_ns, double start_deg, std::int64_t end_ns,
                                  double end_deg) {
  const double hair_deg = (end_deg - start_deg) * static_cast<double>(kHair_ns) /
                          static_cast<double>(end_ns - start_ns);
  return {axis_sample(start_ns - kHair_ns, start_deg - hair_deg),
          axis_sample(end_ns + kHair_ns, end_deg + hair_deg)};
}

Result<std::optional<RecordedEvent>> PlanPlayer::next() {
  while (events_.empty()) {
    if (line_ == plan_.lines.size()) return std::optional<RecordedEvent>();
    if (const Outcome played = play_line(); !played) return Failure{played.reason()};
  }
  std::optional<RecordedEvent> event(std::move(events_.front()));
  events_.pop_front();
  return event;
}

Outcome PlanPlayer::play_line() {
  const RecordedLine& recorded = plan_.lines[line_];
  const RecordedSweep* const sweep = sweep_ < plan_.sweeps.size() ? &plan_.sweeps[sweep_] : nullptr;
  if (sweep != nullptr && line_ == sweep->first_line) open_sweep(*sweep);

  if (recorded.axis) {
    const std::int64_t end_ns = recorded.beam0_time_ns + plan_.line_duration_ns();
    send_axis(msg::AXIS_MEASURED,
              turn(recorded.beam0_time_ns, recorded.axis->first_beam_deg, end_ns,
                   recorded.axis->last_beam_deg),
              recorded.arrival_time_ns);
  }
  msg::ScanLine line = plan_.line;
  line.sequence_number(recorded.sequence_number);
  line.beam0_time_ns(recorded.beam0_time_ns);
  line.arrival_time_ns(recorded.arrival_time_ns);
  line.device_stamp_ms(recorded.device_stamp_ms);
  if (Outcome read = plan_.read_line(line); !read) return read;
  send(std::move(line), recorded.arrival_time_ns);

  ++line_;
  if (sweep != nullptr && line_ == sweep->first_line + sweep->line_count) close_sweep(*sweep);
  return Done{};
}

void PlanPlayer::open_sweep(const RecordedSweep& sweep) {
  const std::int64_t start_ns = window_start_ns(sweep);
  announce(sweep, msg::PHASE_CRUISING, start_ns);
  if (plan_.facts.axis_measured) return;
  const std::int64_t end_ns = window_end_ns(sweep);
  const double turn_s = static_cast<double>(end_ns - sweep.first_beam_time_ns) * 1e-9;
  send_axis(msg::AXIS_COMMANDED,
            turn(sweep.first_beam_time_ns, 0.0, end_ns, sweep.speed_deg_s * turn_s), start_ns);
}

void PlanPlayer::close_sweep(const RecordedSweep& sweep) {
  announce(sweep, msg::PHASE_DECELERATING, window_end_ns(sweep));
  announce(sweep, msg::PHASE_IDLE, window_end_ns(sweep));
  ++sweep_;
}

// The window holds exactly the lines that the sweep should have.
std::int64_t PlanPlayer::window_start_ns(const RecordedSweep& sweep) const {
  return sweep.first_beam_time_ns - kHair_ns;
}

std::int64_t PlanPlayer::window_end_ns(const RecordedSweep& sweep) const {
  const double lines = static_cast<double>(sweep.lines_expected - 1);
  const std::int64_t expected_ns =
      sweep.first_beam_time_ns + std::llround(lines * plan_.line.scan_period_ns());
  const RecordedLine& last = plan_.lines[sweep.first_line + sweep.line_count - 1];
  return std::max(expected_ns, last.beam0_time_ns) + plan_.line_duration_ns() + kHair_ns;
}

void PlanPlayer::announce(const RecordedSweep& sweep, msg::SweepPhase phase, std::int64_t time_ns) {
  msg::Sweep message;
  message.rig(rig_);
  message.sequence_number(++sweeps_sent_);
  message.time_ns(time_ns);
  message.sweep_id(phase == msg::PHASE_IDLE ? 0 : sweep_ + 1);
  message.phase(phase);
  message.mode(sweep.mode);
  message.action_sequence(sweep.action_sequence);
  message.speed_deg_s(sweep.speed_deg_s);
  message.lines_expected(sweep.lines_expected);
  message.window_start_ns(window_start_ns(sweep));
  message.window_end_ns(window_end_ns(sweep));
  message.window_lines(sweep.lines_expected);
  const std::size_t left = plan_.sweeps.size() - sweep_ - 1;
  message.sweeps_left(static_cast<std::uint16_t>(std::min<std::size_t>(left, UINT16_MAX)));
  send(std::move(message), time_ns);
}

void PlanPlayer::send_axis(msg::AxisSource source, std::vector<msg::AxisSample> samples,
                           std::int64_t time_ns) {
  msg::Axis axis;
  axis.rig(rig_);
  axis.sequence_number(++axes_sent_);
  axis.source(source);
  axis.samples(std::move(samples));
  send(std::move(axis), time_ns);
}

template <class Message>
void PlanPlayer::send(Message message, std::int64_t time_ns) {
  time_ns_ = std::max(time_ns_, time_ns);
  events_.push_back({time_ns_, std::move(message)});
}

}  // namespace

Result<Recording> Recording::open(const std::string& path, const std::string& rig) {
  if (is_mcap(path)) return open_mcap_recording(path);
  std::error_code error;
  const bool folder = std::filesystem::is_directory(path, error);
  auto plan = folder ? plan_case_folder(path) : plan_csv_recording(path);
  if (!plan) return Failure{plan.reason()};
  RecordingFacts facts = plan->facts;
  const auto player = std::make_shared<PlanPlayer>(std::move(*plan), rig);
  return Recording(std::move(facts), [player] { return player->next(); });
}

}  // namespace swivel
