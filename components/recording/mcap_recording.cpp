#include "components/recording/mcap_recording.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "components/mcap/reader.hpp"

namespace swivel {
namespace {

struct Window {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
};

struct ToldSweep {
  int mode = 0;
  std::vector<Window> windows;
  bool has_lines = false;
};

// The next message of the hardware's, whatever else is in the file.
class HardwareMessages {
 public:
  HardwareMessages(McapReader reader, std::string rig)
      : reader_(std::move(reader)), rig_(std::move(rig)) {}

  Result<std::optional<RecordedEvent>> next() {
    while (const auto message = reader_.next()) {
      const McapChannel& channel = reader_.channel(message->channel_id);
      const auto known = find_topic(channel.topic);
      if (!known || known->rig != rig_ || channel.message_encoding != "cdr") continue;
      if (comes_from_the_stages(known->topic, message->data)) continue;
      auto event = event_of(known->topic, message->data);
      if (!event) return Failure{"a message of " + channel.topic + " cannot be decoded"};
      time_ns_ = std::max(time_ns_, message->log_time_ns);
      event->time_ns = time_ns_;
      return event;
    }
    if (reader_.damage().none()) return std::optional<RecordedEvent>();
    return Failure{"the recording is not whole; take what is sound of it with: swivel recover"};
  }

 private:
  template <class Message>
  static std::optional<RecordedEvent> decoded(std::string_view cdr) {
    auto message = decode_cdr<Message>(cdr);
    if (!message) return std::nullopt;
    return RecordedEvent{0, std::move(*message)};
  }

  static std::optional<RecordedEvent> event_of(const AnyTopic& topic, std::string_view cdr) {
    if (topic.is(kScanLineTopic)) return decoded<msg::ScanLine>(cdr);
    if (topic.is(kAxisTopic)) return decoded<msg::Axis>(cdr);
    if (topic.is(kSweepTopic)) return decoded<msg::Sweep>(cdr);
    return decoded<msg::Calibration>(cdr);
  }

  McapReader reader_;
  std::string rig_;
  std::int64_t time_ns_ = INT64_MIN;
};

// A first reading: what there is to be made of the file.
class Survey {
 public:
  void add(const msg::ScanLine& line) {
    ++facts_.lines;
    facts_.beams = line.ranges_mm().size();
    facts_.scan_period_ns = line.scan_period_ns();
    line_times_ns_.push_back(line.beam0_time_ns());
  }
  void add(const msg::Axis& axis) {
    facts_.axis_measured = facts_.axis_measured || axis.source() == msg::AXIS_MEASURED;
  }
  void add(const msg::Sweep& sweep) {
    if (sweep.phase() != msg::PHASE_CRUISING || sweep.sweep_id() == 0) return;
    if (sweeps_.count(sweep.sweep_id()) == 0) order_.push_back(sweep.sweep_id());
    ToldSweep& told = sweeps_[sweep.sweep_id()];
    told.mode = sweep.mode();
    told.windows.push_back({sweep.window_start_ns(), sweep.window_end_ns()});
  }
  void add(const msg::Calibration&) {}

  RecordingFacts facts() {
    std::sort(line_times_ns_.begin(), line_times_ns_.end());
    for (const std::uint64_t id : order_) {
      ToldSweep& told = sweeps_[id];
      told.has_lines = std::any_of(told.windows.begin(), told.windows.end(),
                                   [this](const Window& window) { return has_line_in(window); });
      if (told.has_lines) facts_.modes.push_back(told.mode);
    }
    if (facts_.modes.empty()) {
      facts_.remark = "it holds no sweep with its lines; scan_line, axis and sweep are needed";
    }
    return facts_;
  }

  // Told of, but from before the recording began.
  std::set<std::uint64_t> left_out() const {
    std::set<std::uint64_t> ids;
    for (const auto& [id, told] : sweeps_) {
      if (!told.has_lines) ids.insert(id);
    }
    return ids;
  }

 private:
  bool has_line_in(const Window& window) const {
    const auto first =
        std::lower_bound(line_times_ns_.begin(), line_times_ns_.end(), window.start_ns);
    return first != line_times_ns_.end() && *first <= window.end_ns;
  }

  RecordingFacts facts_;
  std::vector<std::int64_t> line_times_ns_;
  std::map<std::uint64_t, ToldSweep> sweeps_;
  std::vector<std::uint64_t> order_;
};

Result<HardwareMessages> open_messages(const std::string& path, const std::string& rig) {
  auto reader = McapReader::open(path);
  if (!reader) return Failure{reader.reason()};
  return HardwareMessages(std::move(*reader), rig);
}

bool is_of(const RecordedEvent& event, const std::set<std::uint64_t>& sweeps) {
  const auto* const sweep = std::get_if<msg::Sweep>(&event.message);
  return sweep != nullptr && sweeps.count(sweep->sweep_id()) > 0;
}

}  // namespace

bool comes_from_the_stages(const AnyTopic& topic, std::string_view cdr) {
  if (topic.is(kScanLineTopic) || topic.is(kAxisTopic) || topic.is(kCalibrationTopic)) {
    return false;
  }
  if (!topic.is(kSweepTopic)) return true;
  const auto sweep = decode_cdr<msg::Sweep>(cdr);
  return sweep && sweep->phase() == msg::PHASE_ASSEMBLED;
}

Result<std::string> rig_in_mcap(const std::string& path) {
  auto reader = McapReader::open(path);
  if (!reader) return Failure{reader.reason()};
  while (const auto message = reader->next()) {
    if (const auto known = find_topic(reader->channel(message->channel_id).topic)) {
      return known->rig;
    }
  }
  return Failure{path + ": there is no topic of Swivel's in it"};
}

Result<Recording> open_mcap_recording(const std::string& path) {
  const auto rig = rig_in_mcap(path);
  if (!rig) return Failure{rig.reason()};
  auto first_reading = open_messages(path, *rig);
  if (!first_reading) return Failure{first_reading.reason()};
  Survey survey;
  while (true) {
    const auto event = first_reading->next();
    if (!event) return Failure{path + ": " + event.reason()};
    if (!event->has_value()) break;
    std::visit([&](const auto& message) { survey.add(message); }, (*event)->message);
  }
  auto messages = open_messages(path, *rig);
  if (!messages) return Failure{messages.reason()};
  RecordingFacts facts = survey.facts();
  facts.rig = *rig;
  const auto shared = std::make_shared<HardwareMessages>(std::move(*messages));
  return Recording(std::move(facts), [shared, left_out = survey.left_out()]() {
    auto event = shared->next();
    while (event && event->has_value() && is_of(**event, left_out)) event = shared->next();
    return event;
  });
}

}  // namespace swivel
