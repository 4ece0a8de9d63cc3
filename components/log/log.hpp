// The log of a program: lines on stderr, each with its time, its level and the program's name.
//
// Only log.cpp knows spdlog: its header brings the whole of fmt's formatting into each file that
// includes it, five seconds of compiling each.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>

namespace swivel {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// `level` is the least that is told: debug, info, warning or error.
void open_log(const std::string& program, const std::string& level);

void log_words(LogLevel level, std::string_view words);

template <typename... Values>
void log_debug(fmt::format_string<Values...> words, Values&&... values) {
  log_words(LogLevel::kDebug, fmt::format(words, std::forward<Values>(values)...));
}

template <typename... Values>
void log_info(fmt::format_string<Values...> words, Values&&... values) {
  log_words(LogLevel::kInfo, fmt::format(words, std::forward<Values>(values)...));
}

template <typename... Values>
void log_warning(fmt::format_string<Values...> words, Values&&... values) {
  log_words(LogLevel::kWarning, fmt::format(words, std::forward<Values>(values)...));
}

template <typename... Values>
void log_error(fmt::format_string<Values...> words, Values&&... values) {
  log_words(LogLevel::kError, fmt::format(words, std::forward<Values>(values)...));
}

}  // namespace swivel
