// What an MCAP file holds, and what is missing in it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/mcap/reader.hpp"
#include "components/mcap/sequence_count.hpp"
#include "hardware/result.hpp"

namespace swivel {

// A channel: what one writer sent on a topic.
struct ChannelOverview {
  McapChannel channel;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  double longest_pause_s = 0.0;
  SequenceCount sequence;

  void add(const McapMessage& message);
};

struct Overview {
  std::string path;
  std::uint64_t size_bytes = 0;
  std::uint64_t chunks = 0;
  std::vector<ChannelOverview> channels;
  McapDamage damage;

  std::uint64_t messages() const;
  std::uint64_t missing() const;  // by the sequence numbers
  double duration_s() const;
};

// Reads all of it.
Result<Overview> look_at(const std::string& path);

std::string overview_in_words(const Overview& overview);
nlohmann::ordered_json overview_json(const Overview& overview);

}  // namespace swivel
