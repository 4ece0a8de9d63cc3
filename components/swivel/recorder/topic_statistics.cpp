#include "components/swivel/recorder/topic_statistics.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "components/common/listed.hpp"

namespace swivel {

void Spread::add(double value) {
  smallest_ = count_ == 0 ? value : std::min(smallest_, value);
  largest_ = count_ == 0 ? value : std::max(largest_, value);
  sum_ += value;
  ++count_;
}

nlohmann::ordered_json Spread::json() const {
  if (count_ == 0) return nullptr;
  return {
      {"smallest", smallest_}, {"mean", sum_ / static_cast<double>(count_)}, {"largest", largest_}};
}

std::string Spread::in_words(const char* unit) const {
  if (count_ == 0) return "not known: too few messages";
  return fmt::format("{:.3f} to {:.3f} {}, mean {:.3f}", smallest_, largest_, unit,
                     sum_ / static_cast<double>(count_));
}

void TopicStatistics::add(const Heard& heard) {
  const double time_s = static_cast<double>(heard.time_ns) * 1e-9;
  if (messages_ == 0) {
    first_s_ = time_s;
  } else {
    interval_ms_.add((time_s - last_s_) * 1e3);
  }
  last_s_ = time_s;
  delay_ms_.add((time_s - static_cast<double>(heard.sent_time_ns) * 1e-9) * 1e3);
  type_ = heard.type;
  participants_.insert(heard.participant);
  bytes_ += heard.size_bytes;
  ++messages_;
}

double TopicStatistics::duration_s() const {
  return last_s_ - first_s_;
}

double TopicStatistics::rate_hz() const {
  return duration_s() > 0.0 ? static_cast<double>(messages_ - 1) / duration_s() : 0.0;
}

nlohmann::ordered_json TopicStatistics::json() const {
  const double bytes_per_s = duration_s() > 0.0 ? static_cast<double>(bytes_) / duration_s() : 0.0;
  return {{"type", type_},
          {"participants", participants_},
          {"messages", messages_},
          {"bytes", bytes_},
          {"rate_hz", rate_hz()},
          {"bytes_per_s", bytes_per_s},
          {"interval_ms", interval_ms_.json()},
          {"delay_ms", delay_ms_.json()}};
}

std::string TopicStatistics::listed() const {
  return fmt::format("{}, {} messages from {}", type_, messages_, swivel::listed(participants_));
}

std::string TopicStatistics::rate() const {
  return fmt::format("{:.3f} Hz; between messages {}", rate_hz(), interval_ms_.in_words("ms"));
}

std::string TopicStatistics::bandwidth() const {
  const double megabytes = static_cast<double>(bytes_) * 1e-6;
  const double rate = duration_s() > 0.0 ? megabytes / duration_s() : 0.0;
  return fmt::format("{:.3f} MB/s; {:.3f} MB in {} messages", rate, megabytes, messages_);
}

std::string TopicStatistics::delay() const {
  return fmt::format("from sending to here {}", delay_ms_.in_words("ms"));
}

}  // namespace swivel
