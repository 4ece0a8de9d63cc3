#include "components/gateway/gateway.hpp"

#include "components/dds/any_topic.hpp"
#include "components/gateway/channels.hpp"
#include "components/gateway/metrics.hpp"
#include "components/gateway/page_messages.hpp"
#include "components/log/log.hpp"
#include "hardware/io/clock.hpp"
#include "swivel_embedded.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

constexpr auto kTick = std::chrono::milliseconds(100);
constexpr auto kStatePeriod = std::chrono::seconds(1);    // when nothing but ages changes
constexpr auto kHealthyWithin = std::chrono::seconds(6);  // a write to DDS may block for 5 s

}  // namespace

Gateway::Gateway(Participant& participant, const RigFile& rig, const ServerOptions& options)
    : rig_(rig),
      health_(participant),
      roll_(participant),
      requests_(participant, kSweepRequestTopic),
      last_tick_ns_(steady_clock::now().time_since_epoch().count()),
      view_(rig, [this](Frame frame) { server_.publish(std::move(frame)); }),
      requester_([this](const msg::SweepRequest& request) {
        requests_.write(msg::SweepRequest(request));
      }),
      server_(options, server_content()) {
  subscribe(participant);
  participant.on_tick(kTick, [this] { tick(); });
  participant.on_tick(std::chrono::seconds(1), [this] { repeat_request(); });
  health_.set_state(msg::HEALTH_OK, "serving port " + std::to_string(port()));
}

ServerContent Gateway::server_content() {
  ServerContent content;
  content.page = kPage;
  content.name = "swivel " + rig_.rig;
  content.channels = foxglove_channels(rig_.rig);
  content.metrics = [this] { return metrics_text(roll_.entries(), steady_clock::now()); };
  content.healthy = [this] {
    const steady_clock::duration since_tick =
        steady_clock::now().time_since_epoch() - steady_clock::duration(last_tick_ns_);
    return since_tick < kHealthyWithin;
  };
  content.whole_state = [this] {
    const std::lock_guard lock(mutex_);
    std::vector<Frame> frames{text_frame(state_message(rig_, view_, roll_.entries(), answer_))};
    if (const auto picture = view_.whole_picture()) frames.push_back(*picture);
    return frames;
  };
  content.page_command = [this](const std::string& text) { obey(text); };
  return content;
}

void Gateway::subscribe(Participant& participant) {
  pass_on(participant, kScanLineTopic, kScanLineChannel,
          [this](const auto& line) { view_.take(line); });
  pass_on(participant, kAxisTopic, kAxisChannel, [this](const auto& axis) { view_.take(axis); });
  pass_on(participant, kSweepTopic, kSweepChannel, [this](const auto& sweep) { take(sweep); });
  pass_on(participant, kAttitudeTopic, kAttitudeChannel,
          [this](const auto& attitude) { view_.take(attitude); });
  pass_on(participant, kCloudTopic, kCloudChannel, [this](const auto& cloud) { take(cloud); });
  pass_on(participant, kCalibrationTopic, kCalibrationChannel, [](const auto&) {});
  pass_on(participant, kHealthTopic, kHealthChannel, [](const auto&) {});
}

template <class Message, class Take>
void Gateway::pass_on(Participant& participant, const Topic<Message>& topic, std::uint32_t channel,
                      Take take) {
  participant.subscribe<Message>(topic, [this, channel, take](const Message& message) {
    if (server_.wanted(channel)) server_.publish(channel, now_ns(), encode_cdr(message));
    const std::lock_guard lock(mutex_);
    take(message);
  });
}

void Gateway::take(const msg::Sweep& sweep) {
  view_.take(sweep);
  if (requester_.saw(sweep)) answer_ = sweep.phase() == msg::PHASE_REFUSED ? sweep.reason() : "";
}

void Gateway::take(const PointCloud2& cloud) {
  const std::string wrong = view_.take(cloud);
  if (wrong.empty()) return;
  ++clouds_refused_;
  health_.error("a cloud was refused: " + wrong);
}

void Gateway::obey(const std::string& text) {
  const std::lock_guard lock(mutex_);
  const auto command = page_command_in(text, rig_);
  if (!command) {
    ++commands_refused_;
    answer_ = command.reason();
  } else if (command->cancel) {
    log_info("the page cancels");
    requester_.cancel();
    requester_.forget();
  } else {
    log_info("the page asks for a sweep in mode {}", command->mode);
    answer_.clear();
    requester_.request(new_request_id(), command->mode, 1);
  }
}

void Gateway::tick() {
  last_tick_ns_ = steady_clock::now().time_since_epoch().count();
  const std::lock_guard lock(mutex_);
  view_.check(steady_clock::now());
  publish_state(steady_clock::now());
  report();
}

void Gateway::repeat_request() {
  const std::lock_guard lock(mutex_);
  if (requester_.check(steady_clock::now())) return;
  requester_.forget();
  answer_ = "stepper_sequencer does not answer; does it run?";
}

void Gateway::publish_state(steady_clock::time_point now) {
  std::string state = state_message(rig_, view_, {}, answer_);
  if (state == last_state_ && now - state_sent_ < kStatePeriod) return;
  server_.publish(text_frame(state_message(rig_, view_, roll_.entries(), answer_)));
  last_state_ = std::move(state);
  state_sent_ = now;
}

void Gateway::report() {
  const ServerCounters counters = server_.counters();
  health_.set_counter("clients", counters.clients);
  health_.set_counter("connections", counters.connections);
  health_.set_counter("connections_refused", counters.connections_refused);
  health_.set_counter("requests_refused", counters.requests_refused);
  health_.set_counter("requests_broken", counters.requests_broken);
  health_.set_counter("messages_refused", counters.messages_refused);
  health_.set_counter("commands_refused", commands_refused_);
  health_.set_counter("frames_sent", counters.frames_sent);
  health_.set_counter("frames_dropped", counters.frames_dropped);
  health_.set_counter("clouds_refused", clouds_refused_);
}

}  // namespace swivel
