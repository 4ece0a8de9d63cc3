// Counts and adds up what is published, as foreign/read_mcap.mjs does with what was recorded.
#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

#include "components/dds/participant.hpp"

namespace swivel {

class Witness {
 public:
  using Values = std::map<std::string, double>;

  explicit Witness(Participant& participant) {
    watch<msg::ScanLine>(participant, kScanLineTopic, [](const msg::ScanLine& line) -> Values {
      return {{"numbers", line.sequence_number()},
              {"beam0_ms", line.beam0_time_ns() % 1000000000 / 1000000},
              {"ranges", sum(line.ranges_mm())},
              {"intensities", sum(line.intensities())},
              {"beam_step_deg", line.beam_step_deg()}};
    });
    watch<msg::Axis>(participant, kAxisTopic, [](const msg::Axis& axis) -> Values {
      double angle_deg = 0.0;
      for (const msg::AxisSample& sample : axis.samples()) angle_deg += sample.angle_deg();
      return {{"samples", axis.samples().size()}, {"angle_deg", angle_deg}};
    });
    watch<msg::Sweep>(participant, kSweepTopic, [](const msg::Sweep& sweep) -> Values {
      return {
          {"ids", sweep.sweep_id()}, {"phases", sweep.phase()}, {"letters", sweep.reason().size()}};
    });
    watch<msg::Attitude>(participant, kAttitudeTopic, [](const msg::Attitude& attitude) -> Values {
      return {{"beta_deg", attitude.beta_deg()}, {"verdicts", attitude.verdict()}};
    });
    for (const auto& topic : {kRawCloudTopic, kCloudTopic}) {
      watch<PointCloud2>(participant, topic, [](const PointCloud2& cloud) -> Values {
        return {{"bytes", cloud.data().size()},
                {"sum", sum(cloud.data())},
                {"seconds", cloud.header().stamp().sec()}};
      });
    }
  }

  nlohmann::json topics() const {
    const std::lock_guard lock(mutex_);
    return topics_;
  }

  double messages(const std::string& topic) const {
    const std::lock_guard lock(mutex_);
    const auto known = topics_.find(topic);
    return known == topics_.end() ? 0.0 : known->second.at("messages");
  }

 private:
  template <class Numbers>
  static double sum(const Numbers& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
  }

  template <class Message, class ValuesOf>
  void watch(Participant& participant, const Topic<Message>& topic, ValuesOf values_of) {
    const std::string name = topic.full_name(participant.rig());
    participant.subscribe<Message>(topic, [this, name, values_of](const Message& message) {
      const std::lock_guard lock(mutex_);
      topics_[name]["messages"] += 1.0;
      for (const auto& [key, value] : values_of(message)) topics_[name][key] += value;
    });
  }

  mutable std::mutex mutex_;
  std::map<std::string, Values> topics_;
};

}  // namespace swivel
