// What lidar and stepper say.
#include <cstdlib>
#include <map>
#include <variant>

#include "hardware/lidar/device_clock.hpp"
#include "hardware/lidar/scip_parser.hpp"
#include "hardware/lidar/scip_replies.hpp"
#include "hardware/stepper/grbl.hpp"
#include "hardware/stepper/stepper_settings.hpp"
#include "tests/fuzz/must.hpp"
#include "tests/fuzz/targets.hpp"

namespace swivel::fuzz {
namespace {

constexpr std::size_t kMostBytesOfAReply = 128 * 1025;

// Cut otherwise, the same bytes are the same replies.
void must_not_depend_on_the_cut(std::string_view bytes, const scip::ParserCounters& whole) {
  scip::Parser parser;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(1 + bytes.size() % 7, bytes.size());
    parser.push(bytes.substr(0, size));
    bytes.remove_prefix(size);
  }
  must(parser.counters().replies == whole.replies);
  must(parser.counters().bad_sums == whole.bad_sums);
  must(parser.counters().resyncs == whole.resyncs);
}

void take_scan(const scip::Reply& reply, scip::Measurement measurement, int beams,
               DeviceClock& clock, std::int64_t arrival_ns) {
  const auto scan = scip::decode_scan(reply, measurement, beams);
  if (!scan) return;
  must(scan->ranges_mm.size() == static_cast<std::size_t>(beams));
  clock.add(scan->stamp_ms, arrival_ns);
}

// What the client makes of a reply, whatever it asked for.
void take(const scip::Reply& reply, DeviceClock& clock, std::int64_t arrival_ns) {
  must(reply.texts.size() <= kMostBytesOfAReply);
  scip::decode_identity(reply);
  scip::decode_state(reply);
  scip::decode_clock(reply);
  scip::status_in_words(reply.echo, reply.status);
  const auto parameters = scip::decode_parameters(reply);
  const int beams = parameters ? parameters->beams() : 4;
  must(beams >= 1 && beams <= 10000);
  take_scan(reply, scip::Measurement::kRanges, beams, clock, arrival_ns);
  take_scan(reply, scip::Measurement::kRangesAndIntensities, beams, clock, arrival_ns);
}

}  // namespace

void scip(std::string_view bytes) {
  scip::Parser parser;
  DeviceClock clock{DeviceClockOptions{}};
  std::int64_t arrival_ns = 0;
  for (const scip::Reply& reply : parser.push(bytes)) take(reply, clock, arrival_ns += 25'000'000);
  must_not_depend_on_the_cut(bytes, parser.counters());
}

void grbl(std::string_view bytes) {
  GrblParser parser;
  std::map<int, double> settings;
  for (const GrblMessage& message : parser.push(bytes)) {
    if (const auto* setting = std::get_if<GrblSetting>(&message))
      settings[setting->number] = setting->value;
    if (const auto* error = std::get_if<GrblError>(&message)) grbl_error_words(error->code);
    if (const auto* alarm = std::get_if<GrblAlarm>(&message)) grbl_alarm_words(alarm->code);
    const auto* status = std::get_if<GrblStatus>(&message);
    if (status != nullptr && status->machine_deg) grbl_jog_line(*status->machine_deg, 1.0);
  }
  const auto read = read_stepper_settings(settings);
  if (!read) return;
  const TurnLimits limits{-75.0, 330.0, 30.0, 720.0};
  advice_on_limits(limits, *read);
  if (check_turn(limits, *read, -1.0, 90.0, 45.0)) must(read->max_speed_deg_s >= 44.9);
}

}  // namespace swivel::fuzz
