// Several values as a reader wants them.
#pragma once

#include <fmt/core.h>

#include <string>

namespace swivel {

// "1, 2, 3"
template <typename Values>
std::string listed(const Values& values) {
  std::string words;
  for (const auto& value : values) words += fmt::format("{}{}", words.empty() ? "" : ", ", value);
  return words;
}

}  // namespace swivel
