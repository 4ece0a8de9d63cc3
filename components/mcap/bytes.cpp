#include "components/mcap/bytes.hpp"

#include <zlib.h>

namespace swivel {

McapEncoder& McapEncoder::number(std::uint64_t value, int bytes) {
  for (int byte = 0; byte < bytes; ++byte) {
    bytes_.push_back(static_cast<char>((value >> (8 * byte)) & 0xFFU));
  }
  return *this;
}

McapEncoder& McapEncoder::raw(std::string_view value) {
  bytes_.append(value);
  return *this;
}

McapEncoder& McapEncoder::text(std::string_view value) {
  return u32(static_cast<std::uint32_t>(value.size())).raw(value);
}

McapEncoder& McapEncoder::texts(const std::map<std::string, std::string>& values) {
  std::string entries;
  McapEncoder encoder(entries);
  for (const auto& [key, value] : values) encoder.text(key).text(value);
  return text(entries);
}

McapEncoder& McapEncoder::counts(const std::map<std::uint16_t, std::uint64_t>& values) {
  u32(static_cast<std::uint32_t>(values.size() * 10));
  for (const auto& [key, value] : values) u16(key).u64(value);
  return *this;
}

McapRecord::McapRecord(std::string& bytes, McapOpcode opcode) : McapEncoder(bytes), bytes_(bytes) {
  u8(static_cast<std::uint8_t>(opcode)).u64(0);
  content_ = bytes.size();
}

McapRecord::~McapRecord() {
  std::string length;
  McapEncoder(length).u64(bytes_.size() - content_);
  bytes_.replace(content_ - length.size(), length.size(), length);
}

std::string_view McapDecoder::raw(std::uint64_t size) {
  if (!ok_ || size > rest_.size()) {
    ok_ = false;
    return {};
  }
  const std::string_view taken = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return taken;
}

std::uint64_t McapDecoder::number(std::size_t bytes) {
  std::uint64_t value = 0;
  std::size_t byte = 0;
  for (const char part : raw(bytes)) {
    value |= std::uint64_t{static_cast<std::uint8_t>(part)} << (8 * byte++);
  }
  return value;
}

std::map<std::string, std::string> McapDecoder::texts() {
  McapDecoder entries(text());
  std::map<std::string, std::string> values;
  while (entries.ok() && !entries.rest().empty()) {
    std::string key(entries.text());
    values[std::move(key)] = std::string(entries.text());
  }
  ok_ = ok_ && entries.ok();
  return values;
}

std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t crc) {
  // zlib takes a null pointer for a wish to begin anew.
  if (bytes.empty()) return crc;
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace swivel
