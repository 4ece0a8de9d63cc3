#include "components/swivel/recorder/recording_files.hpp"

#include <filesystem>

#include "components/swivel/recorder/channels.hpp"

namespace swivel {
namespace {

constexpr auto kChunkDuration = std::chrono::seconds(1);  // what a power cut may cost

std::string numbered(const std::string& path, std::size_t number) {
  if (number == 0) return path;
  const std::filesystem::path whole(path);
  return (whole.parent_path() / whole.stem()).string() + "_" + std::to_string(number) +
         whole.extension().string();
}

}  // namespace

Outcome RecordingFiles::open() {
  auto writer = McapWriter::create(numbered(path_, names_.size()));
  if (!writer) return Failure{writer.reason()};
  writer_.emplace(std::move(*writer));
  names_.push_back(writer_->name());
  safe_time_ = std::chrono::steady_clock::now();
  return check_room();
}

std::optional<std::uint16_t> RecordingFiles::channel_id(const RecordedSample& recorded) {
  const auto key = std::make_pair(recorded.topic, recorded.sample.writer);
  if (const auto known = channel_ids_.find(key); known != channel_ids_.end()) return known->second;
  const auto id = writer_->add_channel(channel_of(*recorded.topic, rig_, recorded.sample));
  if (id) channel_ids_[key] = *id;
  return id;
}

Outcome RecordingFiles::write(const RecordedSample& recorded) {
  const bool full = writer_ && writer_->size_bytes() >= limits_.split_bytes;
  Outcome closed = full ? close() : Outcome(Done{});
  ++not_safe_[recorded.topic];
  if (!closed) return closed;
  Outcome appended = append(recorded);
  if (appended && writer_->is_all_safe()) not_safe_.clear();
  return appended;
}

Outcome RecordingFiles::append(const RecordedSample& recorded) {
  if (!writer_) {
    if (Outcome opened = open(); !opened) return opened;
  }
  auto id = channel_id(recorded);
  if (!id) return Failure{writer_->name() + " has more writers than a file can hold"};
  return writer_->write({*id, static_cast<std::uint32_t>(recorded.sample.number),
                         recorded.log_time_ns, recorded.sample.sent_time_ns, recorded.sample.cdr});
}

Outcome RecordingFiles::keep_safe() {
  const auto now = std::chrono::steady_clock::now();
  if (!writer_ || now < safe_time_ + kChunkDuration) return Done{};
  safe_time_ = now;
  if (Outcome ended = writer_->end_chunk(); !ended) return ended;
  not_safe_.clear();
  return check_room();
}

Outcome RecordingFiles::check_room() const {
  std::error_code error;
  const auto folder = std::filesystem::absolute(path_, error).parent_path();
  const auto room = std::filesystem::space(folder, error);
  if (error || room.available >= limits_.disk_margin_bytes) return Done{};
  return Failure{folder.string() + ": less than " +
                 std::to_string(limits_.disk_margin_bytes >> 20) +
                 " MB are free; make room, or give another --margin-mb"};
}

Outcome RecordingFiles::close() {
  if (!writer_) return Done{};
  const Outcome closed = writer_->close();
  if (closed) not_safe_.clear();
  writer_.reset();
  channel_ids_.clear();
  return closed;
}

}  // namespace swivel
