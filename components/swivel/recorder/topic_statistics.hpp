// How often, how much and how late messages of a topic come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace swivel {

struct Heard {
  std::string topic;  // full name
  std::string type;
  std::string participant;   // the writer's
  std::int64_t time_ns = 0;  // when it came
  std::int64_t sent_time_ns = 0;
  std::size_t size_bytes = 0;
};

// Smallest, mean and largest.
class Spread {
 public:
  void add(double value);
  nlohmann::ordered_json json() const;  // null where there is none
  std::string in_words(const char* unit) const;

 private:
  std::size_t count_ = 0;
  double smallest_ = 0.0;
  double largest_ = 0.0;
  double sum_ = 0.0;
};

class TopicStatistics {
 public:
  void add(const Heard& heard);

  nlohmann::ordered_json json() const;
  // For `swivel ls`, hz, bw and delay.
  std::string listed() const;
  std::string rate() const;
  std::string bandwidth() const;
  std::string delay() const;

 private:
  double duration_s() const;
  double rate_hz() const;  // 0 where one message, or none, came

  std::string type_;
  std::set<std::string> participants_;
  std::size_t messages_ = 0;
  std::uint64_t bytes_ = 0;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  Spread interval_ms_;
  Spread delay_ms_;
};

using StatisticsOfTopics = std::map<std::string, TopicStatistics>;

}  // namespace swivel
