#include "components/dds/fast_dds_log.hpp"

#include <spdlog/spdlog.h>

#include <fastdds/dds/log/Log.hpp>
#include <memory>

namespace swivel {
namespace {

using eprosima::fastdds::dds::Log;

class LogIntoOurs : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    const auto level = entry.kind == Log::Kind::Error ? spdlog::level::warn : spdlog::level::debug;
    spdlog::log(level, "Fast DDS: {}", entry.message);
  }
};

}  // namespace

void log_what_fast_dds_says() {
  Log::ClearConsumers();
  Log::RegisterConsumer(std::make_unique<LogIntoOurs>());
}

}  // namespace swivel
