#include "hardware/sim/scip_sensor.hpp"

#include <algorithm>
#include <utility>

#include "hardware/lidar/scip.hpp"

namespace swivel::sim {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::size_t kLongestRequest = 64;
constexpr std::size_t kLongestString = 16;

std::string reply(const std::string& request, std::string_view status) {
  std::string text = request + "\n";
  scip::append_text(text, status);
  return text;
}

std::string whole_reply(const std::string& request, std::string_view status) {
  return reply(request, status) + "\n";
}

std::string command_of(const std::string& request) {
  return request.substr(0, request.find(';'));
}

}  // namespace

ScipSensor::ScipSensor(SensorModel model, LidarTiming& timing, std::int64_t start_latency_ns)
    : model_(std::move(model)), timing_(&timing), start_latency_ns_(start_latency_ns) {}

void ScipSensor::connect() {
  stop();
  unfinished_.clear();
  clock_mode_ = asleep_ = reboot_requested_ = false;
}

void ScipSensor::stop() {
  orders_.clear();
  laser_on_ = false;
}

// A request ends with LF, CR or both; the empty one between CR and LF is no request.
std::string ScipSensor::receive(std::string_view bytes, std::int64_t now_ns) {
  std::string replies;
  for (const char byte : bytes) {
    if (byte != '\n' && byte != '\r') {
      if (unfinished_.size() <= kLongestRequest) unfinished_ += byte;
      continue;
    }
    const std::string request = std::exchange(unfinished_, {});
    if (!request.empty() && !reboot_requested_) replies += reply_to(request, now_ns);
  }
  return replies;
}

std::string ScipSensor::reply_to(const std::string& request, std::int64_t now_ns) {
  const std::string command = command_of(request);
  if (request.size() > kLongestRequest) return whole_reply(request, "0D");
  if (request.size() > command.size() + 1 + kLongestString) return whole_reply(request, "0G");
  const std::string two = command.substr(0, 2);
  if (two == "MS" || two == "GS") return {};  // a UST does not answer these
  const bool intensities = two == "ME" || two == "GE";
  if (intensities && !model_.tells_intensities) return whole_reply(request, "0E");
  if (two == "MD" || two == "ME" || two == "GD" || two == "GE") return take_order(request, now_ns);
  if (command == "QT") {
    stop();
    return whole_reply(request, "00");
  }
  return reply_to_state_request(request, now_ns);
}

std::string ScipSensor::reply_to_state_request(const std::string& request, std::int64_t now_ns) {
  const std::string command = command_of(request);
  if (command == "VV") return identity(request);
  if (command == "PP") return parameters(request);
  if (command == "II") return state(request, now_ns);
  if (command == "BM") return switch_laser_on(request);
  if (command.rfind("TM", 0) == 0) return clock_mode(request, now_ns);
  if (command == "RS" || command == "RT") return initialise(request, now_ns);
  if (command == "RB") return reboot(request, now_ns);
  if (command == "%ST") return operating_state(request);
  if (command == "%SL") {
    stop();
    asleep_ = true;
    return whole_reply(request, "00");
  }
  return whole_reply(request, "0F");
}

std::string ScipSensor::identity(const std::string& request) const {
  std::string text = reply(request, "00");
  scip::append_key(text, "VEND", "Hokuyo Automatic Co.,Ltd.");
  scip::append_key(text, "PROD", model_.product);
  scip::append_key(text, "FIRM", model_.firmware);
  scip::append_key(text, "PROT", model_.protocol);
  scip::append_key(text, "SERI", model_.serial_number);
  return text + "\n";
}

std::string ScipSensor::parameters(const std::string& request) const {
  std::string text = reply(request, "00");
  scip::append_key(text, "MODL", model_.product);
  scip::append_key(text, "DMIN", std::to_string(model_.said_nearest_mm));
  scip::append_key(text, "DMAX", std::to_string(model_.said_farthest_mm));
  scip::append_key(text, "ARES", std::to_string(model_.steps_per_turn));
  scip::append_key(text, "AMIN", std::to_string(model_.first_step));
  scip::append_key(text, "AMAX", std::to_string(model_.last_step));
  scip::append_key(text, "AFRT", std::to_string(model_.front_step));
  scip::append_key(text, "SCAN", std::to_string(model_.revolutions_per_minute));
  return text + "\n";
}

std::string ScipSensor::state(const std::string& request, std::int64_t now_ns) const {
  std::string text = reply(request, "00");
  scip::append_key(text, "MODL", model_.product);
  scip::append_key(text, "LASR", laser_on_ ? "ON" : "OFF");
  scip::append_key(text, "SCSP", std::to_string(model_.revolutions_per_minute));
  scip::append_key(text, "MESM", "Measuring by Sensitive Mode");
  scip::append_key(text, "SBPS", model_.interface_words);
  scip::append_key(text, "TIME", scip::encode_value(timing_->counter_ms(now_ns), 4));
  scip::append_key(text, "STAT", "sensor is working normally");
  return text + "\n";
}

std::string ScipSensor::operating_state(const std::string& request) const {
  std::string text = reply(request, "00");
  const bool streams = std::any_of(orders_.begin(), orders_.end(),
                                   [](const Order& order) { return order.continuous; });
  const char* state = "000";
  if (laser_on_) state = "003";
  if (streams) state = "004";
  if (clock_mode_) state = "002";
  if (asleep_) state = "005";
  scip::append_text(text, state);
  return text + "\n";
}

std::string ScipSensor::switch_laser_on(const std::string& request) {
  if (clock_mode_) return whole_reply(request, "10");
  const bool was_on = std::exchange(laser_on_, true);
  asleep_ = false;
  return whole_reply(request, was_on ? "02" : "00");
}

// TM1 is answered outside the clock mode too, as real sensors do.
std::string ScipSensor::clock_mode(const std::string& request, std::int64_t now_ns) {
  const std::string command = command_of(request);
  if (command == "TM0") {
    if (!orders_.empty()) return whole_reply(request, "10");
    return whole_reply(request, std::exchange(clock_mode_, true) ? "02" : "00");
  }
  if (command == "TM2") {
    return whole_reply(request, std::exchange(clock_mode_, false) ? "00" : "03");
  }
  if (command != "TM1") return whole_reply(request, "01");
  std::string text = reply(request, "00");
  scip::append_text(text, scip::encode_value(timing_->counter_ms(now_ns), 4));
  return text + "\n";
}

std::string ScipSensor::initialise(const std::string& request, std::int64_t now_ns) {
  stop();
  clock_mode_ = asleep_ = false;
  timing_->reset_counter(now_ns);
  return whole_reply(request, "00");
}

// The second RB within a second reboots.
std::string ScipSensor::reboot(const std::string& request, std::int64_t now_ns) {
  if (now_ns > reboot_armed_until_ns_) {
    reboot_armed_until_ns_ = now_ns + kSecondNs;
    return whole_reply(request, "01");
  }
  stop();
  reboot_armed_until_ns_ = 0;
  reboot_requested_ = true;
  return whole_reply(request, "00");
}

}  // namespace swivel::sim
