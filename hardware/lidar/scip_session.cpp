#include "hardware/lidar/scip_session.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "hardware/io/clock.hpp"

namespace swivel::scip {
namespace {

constexpr int kQuietTries = 3;  // sensors are known to ignore the first QT

Failure no_answer(const std::string& request, const std::string& other_echo) {
  if (other_echo.empty())
    return Failure{"no answer to " + request + ": is this a Hokuyo sensor, and has it started?"};
  return Failure{"no answer to " + request + ", but one to '" + other_echo.substr(0, 40) +
                 "', which was not asked: this is not SCIP 2.2"};
}

std::chrono::milliseconds time_left(Session::Instant deadline) {
  using namespace std::chrono;
  return std::max(milliseconds(0), ceil<milliseconds>(deadline - steady_clock::now()));
}

template <class Value>
Result<Value> decoded(const Result<Reply>& reply, Result<Value> (*decode)(const Reply&)) {
  if (!reply) return Failure{reply.reason()};
  return decode(*reply);
}

}  // namespace

Session::Session(ByteStream stream, const SessionTimeouts& timeouts, const WakeUp* wake_up)
    : stream_(std::move(stream)), timeouts_(timeouts), wake_up_(wake_up) {}

Result<Session> Session::open(const std::string& address, const SessionTimeouts& timeouts,
                              const WakeUp* wake_up, WireTap tap) {
  Result<ByteStream> stream = ByteStream::open(address, timeouts.connect, wake_up, std::move(tap));
  if (!stream) return Failure{stream.reason()};
  Session session(std::move(*stream), timeouts, wake_up);
  const Outcome quiet = session.stop_scans();
  if (!quiet) return Failure{quiet.reason()};
  session.parser_ = Parser{};  // what stood half-way in the line was nobody's fault
  return session;
}

Result<std::optional<TimedReply>> Session::next_reply(Instant deadline) {
  while (waiting_.empty()) {
    const Received received = stream_.read_some(time_left(deadline), wake_up_);
    const std::int64_t arrival_time_ns = now_ns();
    if (received.kind == Received::Kind::kTimeout) return std::optional<TimedReply>();
    if (received.kind == Received::Kind::kInterrupted) return Failure{"interrupted"};
    if (received.kind != Received::Kind::kData) return Failure{received.reason};
    for (Reply& reply : parser_.push(received.bytes))
      waiting_.push_back({std::move(reply), arrival_time_ns});
    if (waiting_.empty() && std::chrono::steady_clock::now() >= deadline)
      return std::optional<TimedReply>();  // bytes without end, and never a reply
  }
  std::optional<TimedReply> next(std::move(waiting_.front()));
  waiting_.pop_front();
  return next;
}

// The reply whose echo is the request; others are scans on their way, or answers to a request
// that was given up.
Result<TimedReply> Session::ask(const std::string& request, std::chrono::milliseconds timeout) {
  const Outcome sent = stream_.write_all(request + "\n", timeout);
  if (!sent) return Failure{sent.reason()};
  const Instant deadline = std::chrono::steady_clock::now() + timeout;
  std::string other_echo;
  for (;;) {
    Result<std::optional<TimedReply>> next = next_reply(deadline);
    if (!next) return Failure{next.reason()};
    if (!*next) return no_answer(request, other_echo);
    if ((*next)->reply.echo == request) return std::move(**next);
    other_echo = (*next)->reply.echo;
    if (std::chrono::steady_clock::now() >= deadline) return no_answer(request, other_echo);
  }
}

Result<Reply> Session::ask_for_done(const std::string& request) {
  Result<TimedReply> answer = ask(request, timeouts_.reply);
  if (!answer) return Failure{answer.reason()};
  if (answer->reply.status != "00")
    return Failure{request + " refused, " + status_in_words(request, answer->reply.status)};
  return std::move(answer->reply);
}

Result<LidarIdentity> Session::identify() {
  return decoded(ask_for_done("VV"), decode_identity);
}

Result<Parameters> Session::read_parameters() {
  return decoded(ask_for_done("PP"), decode_parameters);
}

Result<State> Session::read_state() {
  return decoded(ask_for_done("II"), decode_state);
}

Result<std::vector<ClockReading>> Session::read_clock(int times) {
  const Result<Reply> entered = ask_for_done("TM0");
  if (!entered) return Failure{entered.reason()};
  std::vector<ClockReading> readings;
  std::string reason;
  for (int reading = 0; reading < times && reason.empty(); ++reading) {
    const std::int64_t sent_ns = now_ns();
    const Result<TimedReply> answer = ask("TM1", timeouts_.reply);
    const Result<std::uint32_t> stamp =
        answer ? decode_clock(answer->reply) : Failure{answer.reason()};
    if (!stamp) reason = stamp.reason();
    // A computer's clock that was set back in between makes no reading.
    if (stamp && sent_ns <= answer->arrival_time_ns)
      readings.push_back({*stamp, sent_ns, answer->arrival_time_ns});
  }
  const Result<Reply> left = ask_for_done("TM2");
  if (reason.empty() && !left) reason = left.reason();
  if (!reason.empty()) return Failure{reason};
  return readings;
}

Outcome Session::start_scans(const std::string& request) {
  Result<TimedReply> answer = ask(request, timeouts_.reply);
  if (answer && answer->reply.status == "10") {  // the laser is off: some models want BM first
    const Result<TimedReply> lit = ask("BM", timeouts_.reply);
    if (!lit) return Failure{lit.reason()};
    if (lit->reply.status != "00" && lit->reply.status != "02")
      return Failure{"BM refused, " + status_in_words("BM", lit->reply.status)};
    answer = ask(request, timeouts_.reply);
  }
  if (!answer) return Failure{answer.reason()};
  const Reply& reply = answer->reply;
  if (reply.status == "99")
    return Failure{"scans came without " + request + " being acknowledged: this is not SCIP 2.2"};
  if (reply.status != "00")
    return Failure{request + " refused, " + status_in_words(request, reply.status)};
  return Done{};
}

Outcome Session::stop_scans() {
  for (int tries = 1;; ++tries) {
    const Result<TimedReply> answer = ask("QT", timeouts_.quiet);
    if (answer) return Done{};
    const bool may_repeat = answer.reason().rfind("no answer", 0) == 0;
    if (!may_repeat || tries == kQuietTries) return Failure{answer.reason()};
  }
}

Outcome Session::reset() {
  const Result<Reply> done = ask_for_done("RS");
  return done ? Outcome(Done{}) : Failure{done.reason()};
}

Outcome Session::reboot() {
  const Result<TimedReply> first = ask("RB", timeouts_.reply);
  if (!first) return Failure{first.reason()};
  if (first->reply.status != "01" && first->reply.status != "00")
    return Failure{"RB refused, " + status_in_words("RB", first->reply.status)};
  const Result<Reply> done = ask_for_done("RB");
  return done ? Outcome(Done{}) : Failure{done.reason()};
}

void Session::leave() {
  wake_up_ = nullptr;
  waiting_.clear();
  static_cast<void>(stop_scans());  // a sensor that is gone cannot be silenced
}

}  // namespace swivel::scip
