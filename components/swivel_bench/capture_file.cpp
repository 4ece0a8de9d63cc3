#include "components/swivel_bench/capture_file.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "components/dds/any_topic.hpp"
#include "components/mcap/reader.hpp"

namespace swivel {
namespace {

constexpr std::uint64_t kMostBytesOfACapture = std::uint64_t{1} << 30;

// By the instant when each was opened.
using Connections = std::map<std::int64_t, std::vector<sim::CapturedPiece>>;

struct Wires {
  Connections lidar;
  Connections stepper;
  std::uint64_t bytes = 0;
  std::uint64_t unreadable = 0;
};

std::optional<sim::CapturedPiece::Kind> kind_of(msg::WireKind kind) {
  switch (kind) {
    case msg::WIRE_TO_DEVICE:
      return sim::CapturedPiece::Kind::kToDevice;
    case msg::WIRE_FROM_DEVICE:
      return sim::CapturedPiece::Kind::kFromDevice;
    case msg::WIRE_HUNG_UP:
      return sim::CapturedPiece::Kind::kHungUp;
    default:
      return std::nullopt;
  }
}

void add(const msg::WireBytes& wire, Wires& wires) {
  Connections& connections = wire.device() == msg::WIRE_OF_LIDAR ? wires.lidar : wires.stepper;
  auto& pieces = connections[wire.opened_time_ns()];
  const auto kind = kind_of(wire.kind());
  if (!kind) return;
  pieces.push_back({*kind, wire.time_ns(), wire.offset(),
                    std::string(wire.bytes().begin(), wire.bytes().end())});
  wires.bytes += wire.bytes().size();
}

Outcome read(McapReader& reader, const std::string& path, Wires& wires) {
  while (const auto message = reader.next()) {
    const McapChannel& channel = reader.channel(message->channel_id);
    const auto known = find_topic(channel.topic);
    if (!known || !known->topic.is(kWireTopic)) continue;
    const auto wire = decode_cdr<msg::WireBytes>(message->data);
    if (!wire) {
      ++wires.unreadable;
      continue;
    }
    add(*wire, wires);
    if (wires.bytes > kMostBytesOfACapture)
      return Failure{path + ": more than 1 GB of bytes; take a part of it with: swivel slice"};
  }
  return Done{};
}

std::vector<sim::Conversation> conversations_of(Connections& connections, const std::string& name,
                                                const std::string& at_once, Capture& capture) {
  std::vector<sim::Conversation> conversations;
  std::uint64_t missing = 0;
  std::uint64_t left_out = 0;
  for (auto& [opened_ns, pieces] : connections) {
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
    conversations.push_back(sim::conversation_of(pieces, opened_ns, at_once));
    missing += conversations.back().bytes_missing;
    left_out += conversations.back().bytes_left_out;
  }
  capture.remarks.push_back(name + ": " + std::to_string(conversations.size()) +
                            " connections are in the capture");
  if (missing > 0) {
    capture.remarks.push_back(name + ": " + std::to_string(missing) +
                              " bytes are missing in the capture: it was begun later than the "
                              "connection, or lost some");
  }
  if (left_out > 0) {
    capture.remarks.push_back(name + ": " + std::to_string(left_out) +
                              " bytes that were streamed before the hole are left out");
  }
  return conversations;
}

}  // namespace

Result<Capture> load_capture(const std::string& path) {
  auto reader = McapReader::open(path);
  if (!reader) return Failure{reader.reason()};
  Wires wires;
  if (const Outcome whole = read(*reader, path, wires); !whole) return Failure{whole.reason()};
  if (wires.lidar.empty() && wires.stepper.empty())
    return Failure{path + ": nothing of a wire is in it; swivel capture makes such a file"};
  Capture capture;
  capture.lidar = conversations_of(wires.lidar, "lidar", "", capture);
  capture.stepper = conversations_of(wires.stepper, "stepper", sim::kGrblAtOnce, capture);
  for (const std::string& reason : reader->damage().reasons) capture.remarks.push_back(reason);
  if (wires.unreadable > 0) {
    capture.remarks.push_back(std::to_string(wires.unreadable) +
                              " messages could not be decoded: of another version of Swivel?");
  }
  return capture;
}

}  // namespace swivel
