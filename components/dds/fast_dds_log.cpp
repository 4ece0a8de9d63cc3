#include "components/dds/fast_dds_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>

#include "components/log/log.hpp"

namespace swivel {
namespace {

using eprosima::fastdds::dds::Log;

class LogIntoOurs : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    const auto level = entry.kind == Log::Kind::Error ? LogLevel::kWarning : LogLevel::kDebug;
    log_words(level, "Fast DDS: " + entry.message);
  }
};

}  // namespace

void log_what_fast_dds_says() {
  Log::ClearConsumers();
  Log::RegisterConsumer(std::make_unique<LogIntoOurs>());
}

}  // namespace swivel
