// Reads the messages of an MCAP file in the order in which they were written, and nothing that its
// sums do not cover: a file that was cut, or damaged, gives its whole chunks.
//
// The file is read from its beginning, without its summary, which a cut file does not have.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/mcap/bytes.hpp"
#include "components/mcap/format.hpp"
#include "hardware/result.hpp"

namespace swivel {

// What was not delivered, and why.
struct McapDamage {
  std::uint64_t skipped_bytes = 0;   // that make no sense
  std::uint64_t damaged_chunks = 0;  // whose sum is wrong, or that cannot be read
  std::uint64_t lost_messages =
      0;                // without a channel or a sum; those in damaged chunks not counted
  bool closed = false;  // the file has its end
  std::vector<std::string> reasons;  // the first few, in words

  bool none() const { return closed && reasons.empty(); }
};

class McapReader {
 public:
  static Result<McapReader> open(const std::string& path);

  // The next message; its data is valid until the next call. None at the end.
  std::optional<McapMessage> next();

  // Of a message just delivered.
  const McapChannel& channel(std::uint16_t id) const { return channels_.at(id); }

  const McapDamage& damage() const { return damage_; }  // so far
  std::uint64_t size_bytes() const { return size_; }
  std::uint64_t chunks() const { return chunks_; }  // whole ones so far

 private:
  struct RecordHead {
    std::uint8_t opcode = 0;
    std::uint64_t length = 0;  // of the content, which lies within the file
  };

  McapReader(std::string path, std::ifstream file, std::uint64_t size);
  std::string read(std::uint64_t start, std::uint64_t length);
  std::optional<RecordHead> head_at(std::uint64_t position);
  bool load_next_chunk();
  bool step_over(const RecordHead& head);
  bool ends_here(const RecordHead& head);
  void load_chunk(const RecordHead& head);
  void find_next_chunk();
  std::optional<McapMessage> next_in_chunk();
  void take_schema(McapDecoder content);
  void take_channel(McapDecoder content);
  std::optional<McapMessage> take_message(McapDecoder content);
  void complain(std::uint64_t position, const std::string& reason);

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_;  // of the next record
  std::uint64_t sure_;      // up to here everything was where it should be
  bool ended_ = false;
  int searches_ = 0;
  std::uint64_t chunks_ = 0;
  std::string chunk_;      // its records
  std::string_view rest_;  // of them
  std::uint64_t chunk_start_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  McapDamage damage_;
};

// By its first bytes.
bool is_mcap(const std::string& path);

}  // namespace swivel
