// Files that others recorded.
#include <filesystem>
#include <fstream>

#include "components/mcap/reader.hpp"
#include "components/mcap/whole_file.hpp"
#include "components/recording/recording.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace swivel::fuzz {
namespace {

// In the input of case_folder, between one file and the next. What follows the second is both
// ranges and intensities: they have the same size.
constexpr char kNextFile = '\x1e';

std::string_view take_file(std::string_view& bytes) {
  const std::string_view file = bytes.substr(0, bytes.find(kNextFile));
  bytes.remove_prefix(std::min(file.size() + 1, bytes.size()));
  return file;
}

// In memory, as long as the process runs.
class Folder {
 public:
  Folder() : path_("/dev/shm/swivel_fuzz_" + std::to_string(getpid())) {
    std::filesystem::create_directory(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void hold(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << bytes;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// The bytes as the records of a chunk: no chance finds a sum.
std::string with_sound_sum(std::string_view records) {
  constexpr std::uint64_t kHeadingSize = 40;
  std::string file(kMcapMagic);
  McapEncoder(file)
      .u8(static_cast<std::uint8_t>(McapOpcode::kChunk))
      .u64(kHeadingSize + records.size())
      .u64(0)
      .u64(0)
      .u64(records.size())
      .u32(mcap_crc(records))
      .text("")
      .u64(records.size())
      .raw(records);
  return file;
}

void read_mcap(std::string_view bytes) {
  static const MemoryFile file;
  file.hold(bytes);
  check_file_sums(file.path());
  auto reader = McapReader::open(file.path());
  if (!reader) return must(!reader.reason().empty());
  while (const auto message = reader->next()) {
    must(message->data.size() <= bytes.size());
    reader->channel(message->channel_id);
  }
  must(reader->damage().closed || !reader->damage().none());
}

// Every event, in order of time.
void play(const std::string& path) {
  auto recording = Recording::open(path, "fuzz");
  if (!recording) return must(!recording.reason().empty());
  std::int64_t last_ns = INT64_MIN;
  while (true) {
    const auto event = recording->next();
    if (!event) return must(!event.reason().empty());
    if (!event->has_value()) return;
    must((*event)->time_ns >= last_ns);
    last_ns = (*event)->time_ns;
  }
}

}  // namespace

void mcap(std::string_view bytes) {
  read_mcap(bytes);
  read_mcap(with_sound_sum(bytes));
}

void case_folder(std::string_view bytes) {
  static const Folder folder;
  folder.hold("meta.csv", take_file(bytes));
  folder.hold("lines.csv", take_file(bytes));
  folder.hold("ranges.u16", bytes);
  folder.hold("intensity.u16", bytes);
  play(folder.path());
}

void csv_recording(std::string_view bytes) {
  static const MemoryFile file;
  file.hold(bytes);
  play(file.path());
}

}  // namespace swivel::fuzz
