// Requests and replies over one connection to a sensor. Failures are in words.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "hardware/io/byte_stream.hpp"
#include "hardware/lidar/scip_parser.hpp"
#include "hardware/lidar/scip_replies.hpp"

namespace swivel::scip {

struct TimedReply {
  Reply reply;
  std::int64_t arrival_time_ns = 0;  // when its last byte was read
};

struct ClockReading {
  std::uint32_t stamp_ms = 0;
  std::int64_t sent_ns = 0;
  std::int64_t received_ns = 0;
};

struct SessionTimeouts {
  std::chrono::milliseconds connect{2000};
  std::chrono::milliseconds reply{1000};
  std::chrono::milliseconds quiet{300};  // for the answer to QT, which is sent three times
};

class Session {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  // Connects, and silences what may still be streaming. Every wait ends when `wake_up` is
  // notified, with a Failure.
  static Result<Session> open(const std::string& address, const SessionTimeouts& timeouts,
                              const WakeUp* wake_up, WireTap tap = {});

  Result<LidarIdentity> identify();      // VV
  Result<Parameters> read_parameters();  // PP
  Result<State> read_state();            // II
  // TM0, TM1 so many times, TM2. The sensor must be idle.
  Result<std::vector<ClockReading>> read_clock(int times);
  // MD or ME, with BM before it where the sensor asks for that.
  Outcome start_scans(const std::string& request);
  Outcome stop_scans();  // QT
  Outcome reset();       // RS: back to idle, the timer at zero
  Outcome reboot();      // RB twice; the connection is of no use after it

  // Nothing at the deadline.
  Result<std::optional<TimedReply>> next_reply(Instant deadline);

  // Stops scans, also when the wake-up is notified: the last thing to do.
  void leave();

  const ParserCounters& counters() const { return parser_.counters(); }

 private:
  Session(ByteStream stream, const SessionTimeouts& timeouts, const WakeUp* wake_up);

  Result<TimedReply> ask(const std::string& request, std::chrono::milliseconds timeout);
  Result<Reply> ask_for_done(const std::string& request);

  ByteStream stream_;
  SessionTimeouts timeouts_;
  const WakeUp* wake_up_ = nullptr;
  Parser parser_;
  std::deque<TimedReply> waiting_;
};

}  // namespace swivel::scip
