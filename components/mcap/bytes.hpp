// Numbers, texts and records to bytes and back, as format.hpp spells them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "components/mcap/format.hpp"

namespace swivel {

// Appends to a string of bytes.
class McapEncoder {
 public:
  explicit McapEncoder(std::string& bytes) : bytes_(bytes) {}

  McapEncoder& u8(std::uint8_t value) { return number(value, 1); }
  McapEncoder& u16(std::uint16_t value) { return number(value, 2); }
  McapEncoder& u32(std::uint32_t value) { return number(value, 4); }
  McapEncoder& u64(std::uint64_t value) { return number(value, 8); }
  McapEncoder& time_ns(std::int64_t value) { return u64(static_cast<std::uint64_t>(value)); }
  McapEncoder& raw(std::string_view value);
  McapEncoder& text(std::string_view value);
  McapEncoder& texts(const std::map<std::string, std::string>& values);
  McapEncoder& counts(const std::map<std::uint16_t, std::uint64_t>& values);

 private:
  McapEncoder& number(std::uint64_t value, int bytes);

  std::string& bytes_;
};

// Opens a record; the length is set when the object goes.
class McapRecord : public McapEncoder {
 public:
  McapRecord(std::string& bytes, McapOpcode opcode);
  ~McapRecord();
  McapRecord(const McapRecord&) = delete;
  McapRecord& operator=(const McapRecord&) = delete;

 private:
  std::string& bytes_;
  std::size_t content_;  // where it begins
};

// Takes from the front of bytes that may say anything. What is not there reads as 0 or empty,
// and ok() is false from then on.
class McapDecoder {
 public:
  explicit McapDecoder(std::string_view bytes) : rest_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::int64_t time_ns() { return static_cast<std::int64_t>(u64()); }
  std::string_view raw(std::uint64_t size);
  std::string_view text() { return raw(u32()); }
  std::map<std::string, std::string> texts();

  bool ok() const { return ok_; }
  std::string_view rest() const { return rest_; }
  // Nothing is missing and nothing is left.
  bool used_up() const { return ok_ && rest_.empty(); }

 private:
  std::uint64_t number(std::size_t bytes);

  std::string_view rest_;
  bool ok_ = true;
};

// Of `bytes` after those that gave `crc`.
std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t crc = 0);

}  // namespace swivel
