// Writes an MCAP file: chunks with sums and indexes, not compressed (it gains a tenth, and costs
// the time of a small computer).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "components/mcap/format.hpp"
#include "components/mcap/output_file.hpp"
#include "hardware/result.hpp"

namespace swivel {

class McapWriter {
 public:
  // The file is NAME.part until it is closed. Fails where NAME is already there.
  static Result<McapWriter> create(const std::string& name);

  // None once 65535 are in use.
  std::optional<std::uint16_t> add_channel(const McapChannel& channel);

  // Into the chunk under way, which is ended when it is large.
  Outcome write(const McapMessage& message);
  // What was written so far is safe when this returns.
  Outcome end_chunk();
  Outcome close();

  const std::string& name() const { return file_.name(); }
  std::uint64_t size_bytes() const { return file_.size() + chunk_.size(); }
  bool is_all_safe() const { return chunk_index_.empty(); }

 private:
  explicit McapWriter(OutputFile file) : file_(std::move(file)) {}

  void define(std::uint16_t channel_id, std::string& records) const;
  void define_schema(std::uint16_t schema_id, std::string& records) const;
  void define_in_chunk(std::uint16_t channel_id);
  std::string chunk_heading() const;
  std::string message_indexes(std::map<std::uint16_t, std::uint64_t>& offsets) const;
  void note_chunk(std::uint64_t start, std::uint64_t length,
                  const std::map<std::uint16_t, std::uint64_t>& index_offsets,
                  std::uint64_t indexes_length);
  std::string summary(std::uint64_t start) const;
  void write_statistics(std::string& records) const;

  struct Channel {
    std::uint16_t schema_id;
    McapChannel value;
  };
  struct TimeSpan {
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;
    void include(std::int64_t time_ns, bool first);
  };

  OutputFile file_;
  std::vector<McapSchema> schemas_;  // of id 1 and on
  std::map<std::uint16_t, Channel> channels_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages of each channel
  std::uint64_t message_count_ = 0;
  TimeSpan span_;

  std::string chunk_;  // its records
  TimeSpan chunk_span_;
  std::map<std::uint16_t, std::vector<std::pair<std::int64_t, std::uint64_t>>> chunk_index_;
  std::set<std::uint16_t> defined_;  // channels that stand in this chunk, or not long before
  std::uint32_t chunk_count_ = 0;
  std::string chunk_indexes_;  // records of the summary
};

}  // namespace swivel
