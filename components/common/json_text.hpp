// JSON as text, for a file, a terminal or a browser.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace swivel {

// Words that came over the wire or from a file may be in any encoding; JSON's are UTF-8, and
// its library would throw. What is not becomes the replacement character.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace swivel
