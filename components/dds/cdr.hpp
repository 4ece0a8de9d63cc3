// A message as its bytes on the wire: CDR with its four bytes of encapsulation.
#pragma once

#include <string>

#include "components/dds/topics.hpp"

namespace swivel {

template <class Message>
std::string cdr_of(const Message& message) {
  typename TypeSupportOf<Message>::Type type;
  auto* const data = const_cast<Message*>(&message);  // only read
  eprosima::fastrtps::rtps::SerializedPayload_t payload(type.getSerializedSizeProvider(data)());
  if (!type.serialize(data, &payload)) return {};
  return {reinterpret_cast<const char*>(payload.data), payload.length};
}

}  // namespace swivel
