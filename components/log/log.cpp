#include "components/log/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace swivel {
namespace {

spdlog::level::level_enum of_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void open_log(const std::string& program, const std::string& level) {
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  spdlog::set_pattern("%H:%M:%S.%e %-7l %n: %v");
  spdlog::set_level(spdlog::level::from_str(level));
}

void log_words(LogLevel level, std::string_view words) {
  spdlog::log(of_spdlog(level), spdlog::string_view_t(words.data(), words.size()));
}

}  // namespace swivel
