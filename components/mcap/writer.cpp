#include "components/mcap/writer.hpp"

#include <algorithm>
#include <cassert>

#include "components/mcap/bytes.hpp"

namespace swivel {
namespace {

constexpr std::size_t kLargeChunk = 16U << 20;
// A damaged chunk takes its definitions with it: they are repeated.
constexpr std::uint32_t kChunksPerDefinition = 16;
constexpr std::uint32_t kNoCrc = 0;

}  // namespace

void McapWriter::TimeSpan::include(std::int64_t time_ns, bool first) {
  start_ns = first ? time_ns : std::min(start_ns, time_ns);
  end_ns = first ? time_ns : std::max(end_ns, time_ns);
}

Result<McapWriter> McapWriter::create(const std::string& name) {
  auto file = OutputFile::create(name);
  if (!file) return Failure{file.reason()};
  McapWriter writer(std::move(*file));
  std::string beginning(kMcapMagic);
  McapRecord(beginning, McapOpcode::kHeader).text("").text("swivel");
  if (const Outcome written = writer.file_.append(beginning); !written) {
    return Failure{written.reason()};
  }
  return writer;
}

std::optional<std::uint16_t> McapWriter::add_channel(const McapChannel& channel) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  if (id == 0) return std::nullopt;
  auto schema = std::find(schemas_.begin(), schemas_.end(), channel.schema);
  if (schema == schemas_.end()) schema = schemas_.insert(schema, channel.schema);
  const auto schema_id = static_cast<std::uint16_t>(schema - schemas_.begin() + 1);
  channels_.emplace(id, Channel{schema_id, channel});
  return id;
}

void McapWriter::define_schema(std::uint16_t schema_id, std::string& records) const {
  const McapSchema& schema = schemas_[schema_id - 1U];
  McapRecord(records, McapOpcode::kSchema)
      .u16(schema_id)
      .text(schema.name)
      .text(schema.encoding)
      .text(schema.definition);
}

void McapWriter::define(std::uint16_t channel_id, std::string& records) const {
  const Channel& channel = channels_.at(channel_id);
  McapRecord(records, McapOpcode::kChannel)
      .u16(channel_id)
      .u16(channel.schema_id)
      .text(channel.value.topic)
      .text(channel.value.message_encoding)
      .texts(channel.value.metadata);
}

void McapWriter::define_in_chunk(std::uint16_t channel_id) {
  define_schema(channels_.at(channel_id).schema_id, chunk_);
  define(channel_id, chunk_);
}

Outcome McapWriter::write(const McapMessage& message) {
  assert(channels_.count(message.channel_id) == 1);
  if (defined_.insert(message.channel_id).second) define_in_chunk(message.channel_id);
  chunk_span_.include(message.log_time_ns, chunk_index_.empty());
  span_.include(message.log_time_ns, message_count_ == 0);
  ++message_count_;
  ++counts_[message.channel_id];
  chunk_index_[message.channel_id].emplace_back(message.log_time_ns, chunk_.size());
  McapRecord(chunk_, McapOpcode::kMessage)
      .u16(message.channel_id)
      .u32(message.sequence)
      .time_ns(message.log_time_ns)
      .time_ns(message.publish_time_ns)
      .raw(message.data);
  if (chunk_.size() >= kLargeChunk) return end_chunk();
  return Done{};
}

std::string McapWriter::chunk_heading() const {
  std::string heading;
  McapEncoder(heading)
      .time_ns(chunk_span_.start_ns)
      .time_ns(chunk_span_.end_ns)
      .u64(chunk_.size())
      .u32(mcap_crc(chunk_))
      .text("")
      .u64(chunk_.size());
  std::string record;
  McapEncoder(record)
      .u8(static_cast<std::uint8_t>(McapOpcode::kChunk))
      .u64(heading.size() + chunk_.size())
      .raw(heading);
  return record;
}

std::string McapWriter::message_indexes(std::map<std::uint16_t, std::uint64_t>& offsets) const {
  std::string records;
  for (const auto& [channel_id, entries] : chunk_index_) {
    offsets[channel_id] = records.size();
    McapRecord record(records, McapOpcode::kMessageIndex);
    record.u16(channel_id).u32(static_cast<std::uint32_t>(entries.size() * 16));
    for (const auto& [time_ns, offset] : entries) record.time_ns(time_ns).u64(offset);
  }
  return records;
}

void McapWriter::note_chunk(std::uint64_t start, std::uint64_t length,
                            const std::map<std::uint16_t, std::uint64_t>& index_offsets,
                            std::uint64_t indexes_length) {
  McapRecord(chunk_indexes_, McapOpcode::kChunkIndex)
      .time_ns(chunk_span_.start_ns)
      .time_ns(chunk_span_.end_ns)
      .u64(start)
      .u64(length)
      .counts(index_offsets)
      .u64(indexes_length)
      .text("")
      .u64(chunk_.size())
      .u64(chunk_.size());
}

Outcome McapWriter::end_chunk() {
  if (chunk_index_.empty()) return Done{};
  // A sum of 0 would be read as none: something harmless is added.
  if (mcap_crc(chunk_) == kNoCrc) define_in_chunk(chunk_index_.begin()->first);
  const std::uint64_t start = file_.size();
  const std::string heading = chunk_heading();
  std::map<std::uint16_t, std::uint64_t> index_offsets;
  const std::string indexes = message_indexes(index_offsets);
  for (auto& [channel_id, offset] : index_offsets) offset += start + heading.size() + chunk_.size();
  note_chunk(start, heading.size() + chunk_.size(), index_offsets, indexes.size());
  for (const std::string_view part :
       {std::string_view(heading), std::string_view(chunk_), std::string_view(indexes)}) {
    if (Outcome written = file_.append(part); !written) return written;
  }
  chunk_.clear();
  chunk_index_.clear();
  if (++chunk_count_ % kChunksPerDefinition == 0) defined_.clear();
  return file_.sync();
}

void McapWriter::write_statistics(std::string& records) const {
  McapRecord(records, McapOpcode::kStatistics)
      .u64(message_count_)
      .u16(static_cast<std::uint16_t>(schemas_.size()))
      .u32(static_cast<std::uint32_t>(channels_.size()))
      .u32(0)
      .u32(0)
      .u32(chunk_count_)
      .time_ns(span_.start_ns)
      .time_ns(span_.end_ns)
      .counts(counts_);
}

// Summary and Footer, which begin at `start`.
std::string McapWriter::summary(std::uint64_t start) const {
  std::string records;
  std::string offsets;
  const auto end_group = [&](McapOpcode opcode, std::size_t group_start) {
    if (records.size() == group_start) return records.size();
    McapRecord(offsets, McapOpcode::kSummaryOffset)
        .u8(static_cast<std::uint8_t>(opcode))
        .u64(start + group_start)
        .u64(records.size() - group_start);
    return records.size();
  };
  std::size_t group = 0;
  for (std::size_t i = 0; i < schemas_.size(); ++i) {
    define_schema(static_cast<std::uint16_t>(i + 1), records);
  }
  group = end_group(McapOpcode::kSchema, group);
  for (const auto& [channel_id, channel] : channels_) define(channel_id, records);
  group = end_group(McapOpcode::kChannel, group);
  write_statistics(records);
  group = end_group(McapOpcode::kStatistics, group);
  records += chunk_indexes_;
  group = end_group(McapOpcode::kChunkIndex, group);

  records += offsets;
  McapEncoder footer(records);
  footer.u8(static_cast<std::uint8_t>(McapOpcode::kFooter)).u64(20).u64(start).u64(start + group);
  footer.u32(mcap_crc(records));
  return records;
}

Outcome McapWriter::close() {
  if (Outcome ended = end_chunk(); !ended) return ended;
  std::string end;
  McapRecord(end, McapOpcode::kDataEnd).u32(file_.crc());
  end += summary(file_.size() + end.size());
  end += kMcapMagic;
  if (Outcome written = file_.append(end); !written) return written;
  return file_.finish();
}

}  // namespace swivel
