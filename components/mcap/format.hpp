// MCAP version 0: what Swivel writes and reads of it. Every number is little-endian.
//
//   File    = Magic Header {Chunk {MessageIndex}} DataEnd Summary {SummaryOffset} Footer Magic
//   Summary = {Schema} {Channel} Statistics {ChunkIndex}
//   Magic   = 89 4D 43 41 50 30 0D 0A
//   Record  = opcode:u8 length:u64 content[length]
//   text    = length:u32 byte[length]
//   map K V = length:u32 {K V}          the length is of its bytes
//
//   01 Header         profile:text library:text
//   02 Footer         summary_start:u64 summary_offset_start:u64 summary_crc:u32
//   03 Schema         id:u16 name:text encoding:text definition:text
//   04 Channel        id:u16 schema_id:u16 topic:text message_encoding:text metadata:map text text
//   05 Message        channel_id:u16 sequence:u32 log_time_ns:u64 publish_time_ns:u64 data
//   06 Chunk          start_time_ns:u64 end_time_ns:u64 uncompressed_size:u64 crc:u32
//                     compression:text records_size:u64 {Schema | Channel | Message}
//   07 MessageIndex   channel_id:u16 map log_time_ns:u64 offset_in_chunk:u64
//   08 ChunkIndex     start_time_ns:u64 end_time_ns:u64 chunk_start:u64 chunk_length:u64
//                     message_indexes:map u16 u64  message_indexes_length:u64
//                     compression:text compressed_size:u64 uncompressed_size:u64
//   0B Statistics     messages:u64 schemas:u16 channels:u32 attachments:u32 metadata:u32 chunks:u32
//                     start_time_ns:u64 end_time_ns:u64 messages_of_channel:map u16 u64
//   0E SummaryOffset  opcode:u8 start:u64 length:u64
//   0F DataEnd        data_crc:u32
//
// A crc is CRC-32 (zlib's); 0 stands for none. That of a chunk is of its records; that of the
// data is of the file up to DataEnd; that of the summary ends before itself. Schema 0 is none.
// 09, 0A, 0C and 0D (attachments, metadata) are written by others, and skipped.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace swivel {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

enum class McapOpcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kMetadata = 0x0C,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

struct McapSchema {
  std::string name;
  std::string encoding;  // of the definition: "omgidl", "ros2msg"
  std::string definition;

  bool operator==(const McapSchema& other) const {
    return name == other.name && encoding == other.encoding && definition == other.definition;
  }
};

// What one writer sent on one topic; several channels may share a topic.
struct McapChannel {
  std::string topic;
  std::string message_encoding;  // "cdr"
  McapSchema schema;
  std::map<std::string, std::string> metadata;
};

struct McapMessage {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;  // its writer's count: a hole is a loss
  std::int64_t log_time_ns = 0;
  std::int64_t publish_time_ns = 0;
  std::string_view data;  // of whoever made the message
};

}  // namespace swivel
