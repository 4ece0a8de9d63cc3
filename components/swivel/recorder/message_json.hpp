// Messages as JSON, for people and their scripts. A cloud comes without its points.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "components/dds/any_topic.hpp"

namespace swivel {

// None where the bytes are no such message.
std::optional<nlohmann::ordered_json> message_json(const AnyTopic& topic, std::string_view cdr);

}  // namespace swivel
