// The files of one recording, one after the other: FILE.mcap, FILE_1.mcap, FILE_2.mcap ...
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/mcap/writer.hpp"
#include "components/swivel/recorder/sample_queue.hpp"
#include "hardware/result.hpp"

namespace swivel {

struct RecordingLimits {
  std::uint64_t split_bytes = UINT64_MAX;       // a new file from this size on
  std::uint64_t disk_margin_bytes = 200 << 20;  // stays free on the disk
};

class RecordingFiles {
 public:
  RecordingFiles(std::string path, std::string rig, RecordingLimits limits)
      : path_(std::move(path)), rig_(std::move(rig)), limits_(limits) {}

  Outcome open();  // the next one
  bool is_open() const { return writer_.has_value(); }
  Outcome write(const RecordedSample& sample);
  // Once a second brings what was written to the disk, and looks at the room there.
  Outcome keep_safe();
  Outcome close();

  const std::vector<std::string>& names() const { return names_; }
  // Messages that were given to write() and that no file is known to hold: after a failure, lost.
  const std::map<const AnyTopic*, std::uint64_t>& not_safe() const { return not_safe_; }

 private:
  Outcome append(const RecordedSample& sample);
  std::optional<std::uint16_t> channel_id(const RecordedSample& sample);
  Outcome check_room() const;

  std::string path_;
  std::string rig_;
  RecordingLimits limits_;
  std::optional<McapWriter> writer_;
  std::vector<std::string> names_;
  // By topic and writer: each writer counts for itself, and so is a channel.
  std::map<std::pair<const AnyTopic*, std::string>, std::uint16_t> channel_ids_;
  std::chrono::steady_clock::time_point safe_time_;
  std::map<const AnyTopic*, std::uint64_t> not_safe_;
};

}  // namespace swivel
