#include "components/swivel/recorder/copy_recording.hpp"

#include <algorithm>
#include <map>

#include "components/mcap/writer.hpp"
#include "components/swivel/recorder/time_filter.hpp"

namespace swivel {

Result<Copied> copy_recording(const std::string& from, const std::string& to,
                              const TimeWindow& window, const std::vector<std::string>& topics) {
  auto reader = McapReader::open(from);
  if (!reader) return Failure{reader.reason()};
  auto writer = McapWriter::create(to);
  if (!writer) return Failure{writer.reason()};
  Copied copied;
  TimeFilter filter(window);
  std::map<std::uint16_t, std::uint16_t> ids;  // of channels there and here
  while (auto message = reader->next()) {
    const McapChannel& channel = reader->channel(message->channel_id);
    const bool named =
        topics.empty() || std::find(topics.begin(), topics.end(), channel.topic) != topics.end();
    if (!filter.takes(channel.topic, message->log_time_ns) || !named) continue;
    if (ids.count(message->channel_id) == 0) {
      const auto id = writer->add_channel(channel);
      if (!id) return Failure{from + " has more channels than a file can hold"};
      ids[message->channel_id] = *id;
    }
    message->channel_id = ids[message->channel_id];
    if (const Outcome written = writer->write(*message); !written) {
      return Failure{written.reason()};
    }
    ++copied.messages;
  }
  if (const Outcome closed = writer->close(); !closed) return Failure{closed.reason()};
  copied.damage = reader->damage();
  return copied;
}

}  // namespace swivel
