// The scan requests MD, ME, GD, GE and their frames.
#include <algorithm>
#include <cassert>

#include "hardware/lidar/scip.hpp"
#include "hardware/sim/scip_sensor.hpp"

namespace swivel::sim {
namespace {

constexpr std::size_t kSingleLength = 10;      // start4 end4 cluster2
constexpr std::size_t kContinuousLength = 13;  // and interval1 scans2

std::optional<int> digits(const std::string& text, std::size_t from, std::size_t count) {
  int value = 0;
  for (std::size_t i = from; i < from + count; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = value * 10 + (text[i] - '0');
  }
  return value;
}

std::string two_digits(int value) {
  return {static_cast<char>('0' + value / 10), static_cast<char>('0' + value % 10)};
}

// The nearest of each `cluster` beams, with its intensity.
std::size_t nearest_of(const LineReading& line, std::size_t from, std::size_t end) {
  const auto begin = line.ranges_mm.begin();
  const auto nearest = std::min_element(begin + static_cast<std::ptrdiff_t>(from),
                                        begin + static_cast<std::ptrdiff_t>(end));
  return static_cast<std::size_t>(nearest - begin);
}

}  // namespace

// The status of a refusal, or nullptr (C-42-03320, the status codes of MD).
const char* ScipSensor::parse_order(const std::string& parameters, Order& order) const {
  const std::size_t length = order.continuous ? kContinuousLength : kSingleLength;
  if (parameters.size() != length) return parameters.size() < length ? "0H" : "0D";
  const auto first = digits(parameters, 0, 4);
  const auto last = digits(parameters, 4, 4);
  const auto cluster = digits(parameters, 8, 2);
  if (!first) return "01";
  if (!last) return "02";
  if (!cluster) return "03";
  if (*first < model_.first_step || *last > model_.last_step) return "04";
  if (*last < *first) return "05";
  order.first_step = *first;
  order.last_step = *last;
  order.cluster = std::max(1, *cluster);
  if (!order.continuous) return order.remaining = 1, nullptr;
  const auto interval = digits(parameters, 10, 1);
  const auto scans = digits(parameters, 11, 2);
  if (!interval) return "06";
  if (!scans) return "07";
  order.interval = *interval;
  if (*scans > 0) order.remaining = *scans;
  return nullptr;
}

std::string ScipSensor::take_order(const std::string& request, std::int64_t now_ns) {
  const std::string command = request.substr(0, request.find(';'));
  Order order;
  order.continuous = command[0] == 'M';
  order.intensities = command[1] == 'E';
  order.string = request.substr(command.size());
  const char* refusal = parse_order(command.substr(2), order);
  if (refusal == nullptr && !allowed(order)) refusal = "10";
  if (refusal == nullptr) {
    order.request = order.continuous ? command.substr(0, command.size() - 2) : command;
    order.scan = timing_->next_scan(now_ns + (order.continuous ? start_latency_ns_ : 0));
    accept(order);
    if (!order.continuous) return {};  // its frame is the reply
  }
  std::string acknowledgement = request + "\n";
  scip::append_text(acknowledgement, refusal != nullptr ? refusal : "00");
  return acknowledgement + "\n";
}

bool ScipSensor::allowed(const Order& order) const {
  if (clock_mode_) return false;
  const bool single_waits = std::any_of(orders_.begin(), orders_.end(),
                                        [](const Order& other) { return !other.continuous; });
  return order.continuous || (laser_on_ && !single_waits);
}

// MD and ME switch the laser on; the newer of two replaces the older.
void ScipSensor::accept(const Order& order) {
  if (order.continuous) {
    orders_.erase(std::remove_if(orders_.begin(), orders_.end(),
                                 [](const Order& other) { return other.continuous; }),
                  orders_.end());
    laser_on_ = true;
    asleep_ = false;
  }
  orders_.push_back(order);
}

std::optional<std::uint64_t> ScipSensor::wanted_scan() const {
  std::optional<std::uint64_t> wanted;
  for (const Order& order : orders_) {
    if (!wanted || order.scan < *wanted) wanted = order.scan;
  }
  return wanted;
}

std::vector<std::string> ScipSensor::deliver(const LineReading& line) {
  assert(wanted_scan());
  const std::uint64_t scan = *wanted_scan();
  std::vector<std::string> frames;
  for (Order& order : orders_) {
    if (order.scan != scan) continue;
    if (order.remaining) --*order.remaining;
    frames.push_back(frame(order, line));
    order.scan += static_cast<std::uint64_t>(order.interval) + 1;
  }
  orders_.erase(std::remove_if(orders_.begin(), orders_.end(),
                               [](const Order& order) { return order.remaining == 0; }),
                orders_.end());
  return frames;
}

// The echo of MD and ME ends with the number of scans that are still to come.
std::string ScipSensor::frame(const Order& order, const LineReading& line) const {
  std::string text = order.request;
  if (order.continuous) text += two_digits(order.remaining.value_or(0));
  text += order.string + "\n";
  scip::append_text(text, order.continuous ? "99" : "00");
  scip::append_text(text, scip::encode_value(timing_->stamp_ms(order.scan), 4));
  std::string data;
  const auto beam_of = [&](int step) { return static_cast<std::size_t>(step - model_.first_step); };
  const std::size_t end = std::min(line.ranges_mm.size(), beam_of(order.last_step) + 1);
  const auto cluster = static_cast<std::size_t>(order.cluster);
  for (std::size_t beam = beam_of(order.first_step); beam < end; beam += cluster) {
    const std::size_t chosen = nearest_of(line, beam, std::min(end, beam + cluster));
    scip::append_value(data, line.ranges_mm[chosen], 3);
    if (order.intensities) scip::append_value(data, line.intensities[chosen], 3);
  }
  scip::append_data(text, data);
  return text + "\n";
}

}  // namespace swivel::sim
