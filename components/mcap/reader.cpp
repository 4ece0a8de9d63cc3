#include "components/mcap/reader.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace swivel {
namespace {

constexpr std::uint64_t kHeadSize = 9;  // opcode and length
constexpr std::uint64_t kChunkHeadingSize =
    40;  // before the records, where they are not compressed
constexpr std::uint64_t kFooterSize = 20;
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;
constexpr std::uint64_t kLargestIndex = std::uint64_t{1} << 26;
constexpr std::size_t kSearchBlock = 1 << 20;
constexpr char kChunkByte = static_cast<char>(McapOpcode::kChunk);
constexpr int kMostSearches = 1000;  // each may read the rest of the file
constexpr std::size_t kMostReasons = 20;

struct ChunkHeading {
  std::uint64_t uncompressed_size;
  std::uint32_t crc;
  std::string_view compression;
  std::uint64_t records_size;

  explicit ChunkHeading(McapDecoder content) {
    content.u64();
    content.u64();
    uncompressed_size = content.u64();
    crc = content.u32();
    compression = content.text();
    records_size = content.u64();
  }

  // Not compressed, and its three sizes agree.
  bool is_plain(std::uint64_t record_length) const {
    return compression.empty() && records_size == uncompressed_size &&
           records_size <= kLargestChunk && records_size + kChunkHeadingSize == record_length;
  }
};

// Of a record's content, as far as it tells a record from bytes that happen to look like one.
bool well_formed(McapOpcode opcode, McapDecoder content) {
  switch (opcode) {
    case McapOpcode::kHeader:
      content.text();
      content.text();
      return content.used_up();
    case McapOpcode::kSchema:
      content.u16();
      for (int text = 0; text < 3; ++text) content.text();
      return content.used_up();
    case McapOpcode::kChannel:
      content.u32();
      for (int text = 0; text < 3; ++text) content.text();
      return content.used_up();
    case McapOpcode::kMessageIndex:
      content.u16();
      content.text();
      return content.used_up();
    default:
      return false;
  }
}

// Whether `bytes`, after which the file has `there` bytes, begin with a chunk that can be read.
bool plausible_chunk(std::string_view bytes, std::uint64_t there) {
  if (bytes.size() < kHeadSize + kChunkHeadingSize) return false;
  McapDecoder decoder(bytes.substr(1));
  const std::uint64_t length = decoder.u64();
  return length <= std::min(there - kHeadSize, kLargestChunk) &&
         ChunkHeading(decoder).is_plain(length);
}

bool written_by_others(std::uint8_t opcode) {
  return opcode == static_cast<std::uint8_t>(McapOpcode::kAttachment) ||
         opcode == static_cast<std::uint8_t>(McapOpcode::kMetadata);
}

}  // namespace

McapReader::McapReader(std::string path, std::ifstream file, std::uint64_t size)
    : path_(std::move(path)),
      file_(std::move(file)),
      size_(size),
      position_(kMcapMagic.size()),
      sure_(position_) {}

Result<McapReader> McapReader::open(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Failure{path + ": there is no such file"};
  }
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (!file || error) return Failure{path + ": cannot be opened"};
  McapReader reader(path, std::move(file), size);
  if (reader.read(0, kMcapMagic.size()) != kMcapMagic) {
    return Failure{path + ": this is no MCAP file"};
  }
  return reader;
}

// Less than asked for where the file ends or cannot be read.
std::string McapReader::read(std::uint64_t start, std::uint64_t length) {
  const std::uint64_t there = start < size_ ? std::min(length, size_ - start) : 0;
  std::string bytes(there, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(start));
  file_.read(bytes.data(), static_cast<std::streamsize>(there));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file_.gcount(), 0)));
  return bytes;
}

std::optional<McapMessage> McapReader::next() {
  while (true) {
    if (auto message = next_in_chunk()) return message;
    if (!load_next_chunk()) return std::nullopt;
  }
}

std::optional<McapReader::RecordHead> McapReader::head_at(std::uint64_t position) {
  const std::string bytes = read(position, kHeadSize);
  McapDecoder decoder(bytes);
  const RecordHead head{decoder.u8(), decoder.u64()};
  if (!decoder.ok() || head.length > size_ - position - kHeadSize) return std::nullopt;
  return head;
}

// False at the end of the file. The chunk may be empty, where it is damaged.
bool McapReader::load_next_chunk() {
  while (!ended_) {
    if (position_ == size_) break;  // not closed, but cut between two records
    const auto head = head_at(position_);
    if (head && head->opcode == static_cast<std::uint8_t>(McapOpcode::kChunk)) {
      load_chunk(*head);
      return true;
    }
    if (!head || !step_over(*head)) find_next_chunk();
  }
  return false;
}

// A record that is no chunk. False where it cannot be one of those that may stand here.
bool McapReader::step_over(const RecordHead& head) {
  if (ends_here(head)) {
    ended_ = damage_.closed = true;
    return true;
  }
  const auto opcode = static_cast<McapOpcode>(head.opcode);
  if (opcode == McapOpcode::kMessage) {
    ++damage_.lost_messages;
    complain(position_, "a message outside of a chunk: no sum covers it");
  } else if (!written_by_others(head.opcode)) {
    if (head.length > kLargestIndex) return false;
    const std::string content = read(position_ + kHeadSize, head.length);
    if (!well_formed(opcode, McapDecoder(content))) return false;
  }
  position_ += kHeadSize + head.length;
  return true;
}

// DataEnd, and the footer at the end of the file knows of it.
bool McapReader::ends_here(const RecordHead& head) {
  if (head.opcode != static_cast<std::uint8_t>(McapOpcode::kDataEnd) || head.length != 4) {
    return false;
  }
  const std::uint64_t end = position_ + kHeadSize + head.length;
  const std::uint64_t footer_size = kHeadSize + kFooterSize + kMcapMagic.size();
  if (size_ < end + footer_size) return false;
  const std::string bytes = read(size_ - footer_size, footer_size);
  McapDecoder footer(bytes);
  if (footer.u8() != static_cast<std::uint8_t>(McapOpcode::kFooter)) return false;
  footer.u64();
  const std::uint64_t summary_start = footer.u64();
  const bool without_summary = summary_start == 0 && size_ == end + footer_size;
  return (summary_start == end || without_summary) &&
         bytes.compare(kHeadSize + kFooterSize, std::string::npos, kMcapMagic) == 0;
}

void McapReader::load_chunk(const RecordHead& head) {
  const std::uint64_t start = position_ + kHeadSize;
  chunk_start_ = position_;
  chunk_.clear();
  rest_ = {};
  const std::string heading_bytes = read(start, kChunkHeadingSize);
  const ChunkHeading heading{McapDecoder(heading_bytes)};
  if (!heading.is_plain(head.length)) {
    ++damage_.damaged_chunks;
    const bool compressed = heading.compression == "lz4" || heading.compression == "zstd";
    complain(position_, compressed ? "a compressed chunk: Swivel does not read those"
                                   : "a chunk whose heading is damaged");
    return find_next_chunk();
  }
  chunk_ = read(start + kChunkHeadingSize, heading.records_size);
  position_ = sure_ = start + head.length;
  if (chunk_.size() == heading.records_size && heading.crc != 0 &&
      mcap_crc(chunk_) == heading.crc) {
    rest_ = chunk_;
    ++chunks_;
    return;
  }
  ++damage_.damaged_chunks;
  complain(chunk_start_, heading.crc == 0 ? "a chunk without a sum" : "a chunk with a wrong sum");
}

// From where all was well on: a chunk says its size three times, few bytes look so by chance.
void McapReader::find_next_chunk() {
  complain(position_, "what stands here is no record");
  ended_ = true;
  if (++searches_ > kMostSearches) return complain(sure_, "too much damage: the rest is left out");
  for (std::uint64_t start = sure_; start < size_; start += kSearchBlock) {
    const std::string block = read(start, kSearchBlock + kHeadSize + kChunkHeadingSize);
    for (std::size_t i = block.find(kChunkByte); i < kSearchBlock;
         i = block.find(kChunkByte, i + 1)) {
      if (!plausible_chunk(std::string_view(block).substr(i), size_ - start - i)) continue;
      damage_.skipped_bytes += start + i - sure_;
      position_ = sure_ = start + i;
      ended_ = false;
      return;
    }
  }
  damage_.skipped_bytes += size_ - position_;
}

std::optional<McapMessage> McapReader::next_in_chunk() {
  while (!rest_.empty()) {
    McapDecoder decoder(rest_);
    const auto opcode = static_cast<McapOpcode>(decoder.u8());
    const McapDecoder content(decoder.raw(decoder.u64()));
    if (!decoder.ok()) {
      ++damage_.damaged_chunks;
      complain(chunk_start_, "a record in this chunk goes beyond it");
      rest_ = {};
      break;
    }
    rest_ = decoder.rest();
    if (opcode == McapOpcode::kSchema) take_schema(content);
    if (opcode == McapOpcode::kChannel) take_channel(content);
    if (opcode != McapOpcode::kMessage) continue;
    if (auto message = take_message(content)) return message;
  }
  return std::nullopt;
}

void McapReader::take_schema(McapDecoder content) {
  const std::uint16_t id = content.u16();
  McapSchema schema;
  schema.name = content.text();
  schema.encoding = content.text();
  schema.definition = content.text();
  if (content.ok()) schemas_[id] = std::move(schema);
}

void McapReader::take_channel(McapDecoder content) {
  const std::uint16_t id = content.u16();
  const auto schema = schemas_.find(content.u16());
  McapChannel channel;
  channel.topic = content.text();
  channel.message_encoding = content.text();
  channel.metadata = content.texts();
  if (schema != schemas_.end()) channel.schema = schema->second;
  if (content.ok()) channels_[id] = std::move(channel);
}

std::optional<McapMessage> McapReader::take_message(McapDecoder content) {
  McapMessage message;
  message.channel_id = content.u16();
  message.sequence = content.u32();
  message.log_time_ns = content.time_ns();
  message.publish_time_ns = content.time_ns();
  message.data = content.rest();
  if (content.ok() && channels_.count(message.channel_id) == 1) return message;
  ++damage_.lost_messages;
  complain(chunk_start_, "a message of a channel that was lost with a damaged chunk");
  return std::nullopt;
}

void McapReader::complain(std::uint64_t position, const std::string& reason) {
  if (damage_.reasons.size() >= kMostReasons) return;
  damage_.reasons.push_back(path_ + ": at byte " + std::to_string(position) + ": " + reason);
}

bool is_mcap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(kMcapMagic.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file.good() && start == kMcapMagic;
}

}  // namespace swivel
