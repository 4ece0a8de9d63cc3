#include "hardware/sim/captured_device.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr std::size_t kLongestUnanswered = 1000;
// Less than that is how computers are; to follow it would disturb who times the stream.
constexpr std::int64_t kNegligible_ns = 150 * kMillisecond_ns;
constexpr std::int64_t kSmallStep_ns = 300 * kMillisecond_ns;  // which no client takes amiss

// As it can stand in a log.
std::string readable(const std::string& request) {
  std::string words = "'";
  for (const char character : request) {
    if (character == '\n' || character == '\r') continue;
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned char>(character));
    words += std::isprint(static_cast<unsigned char>(character)) != 0 ? std::string(1, character)
                                                                      : std::string(escaped);
  }
  return words + "'";
}

}  // namespace

CapturedDevice::CapturedDevice(std::string name, std::vector<Conversation> conversations,
                               std::string at_once, OnNews on_news)
    : name_(std::move(name)),
      conversations_(std::move(conversations)),
      at_once_(std::move(at_once)),
      on_news_(std::move(on_news)) {}

const std::vector<Exchange>& CapturedDevice::exchanges() const {
  static const std::vector<Exchange> none;
  if (connections_ == 0 || conversations_.empty()) return none;
  return conversations_[(connections_ - 1) % conversations_.size()].exchanges;
}

void CapturedDevice::power_up(std::int64_t now_ns) {
  received_.clear();
  output_.clear();
  last_standing_.clear();
  hangs_up_ = false;
  const bool anew = connections_ > 0 && connections_ % conversations_.size() == 0;
  if (anew)
    on_news_(name_ + ": was connected to more often than captured: the capture begins anew");
  if (!conversations_.empty()) ++connections_;
  begin(0, now_ns);
}

void CapturedDevice::begin(std::size_t exchange, std::int64_t now_ns) {
  exchange_ = exchange;
  answer_ = 0;
  asked_ns_ = now_ns;
  if (on_line_ && exchange < exchanges().size())
    on_line_(exchanges()[exchange].request, exchanges()[exchange].time_ns, now_ns);
}

void CapturedDevice::align(std::int64_t captured_ns, std::int64_t now_ns) {
  if (exchange_ >= exchanges().size()) return;
  const Exchange& exchange = exchanges()[exchange_];
  if (exchange.answers.empty()) return;
  const Answer& next = exchange.answers[std::min(answer_, exchange.answers.size() - 1)];
  const std::int64_t behind_ns =
      captured_ns - (next.time_ns - (asked_ns_ + next.delay_ns - now_ns));
  if (std::abs(behind_ns) < kNegligible_ns) return;
  if (std::abs(behind_ns) < kSmallStep_ns) {
    asked_ns_ -= behind_ns;
    return;
  }
  const auto starts_there = [&](const Answer& answer) {
    return answer.time_ns >= captured_ns &&
           answer.bytes.compare(0, exchange.request.size(), exchange.request) == 0;
  };
  const auto found = std::find_if(exchange.answers.begin(), exchange.answers.end(), starts_there);
  if (found == exchange.answers.end()) return;
  answer_ = static_cast<std::size_t>(found - exchange.answers.begin());
  asked_ns_ = now_ns + (found->time_ns - captured_ns) - found->delay_ns;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%+.1f s", static_cast<double>(behind_ns) * 1e-9);
  on_news_(name_ + ": goes on " + seconds + " from there, to what was captured with this turn");
}

void CapturedDevice::receive(std::string_view bytes, std::int64_t now_ns) {
  advance(now_ns);
  received_ += bytes;
  for (std::string request = take_request(received_, at_once_); !request.empty();
       request = take_request(received_, at_once_)) {
    take(request, now_ns);
  }
  if (received_.size() <= kLongestUnanswered) return;
  differ("what is sent has no line end");
  received_.clear();
}

bool CapturedDevice::asks_how_it_stands(const std::string& request) const {
  return !at_once_.empty() && request == at_once_.substr(0, 1);
}

void CapturedDevice::take(const std::string& request, std::int64_t now_ns) {
  if (found_among_questions(request)) {
    ++exchange_;
    return begin(exchange_, now_ns);
  }
  if (asks_how_it_stands(request) && !last_standing_.empty()) {
    output_ += last_standing_;  // it asks more often: nothing has changed
    return;
  }
  const std::size_t next = exchange_ + 1;
  const std::string captured = next < exchanges().size()
                                   ? "the capture has " + readable(exchanges()[next].request)
                                   : std::string("the captured connection is at its end");
  if (found_later(request)) {
    differ(readable(request) + " was sent where " + captured + "; what is in between is left out");
    ++exchange_;
    return begin(exchange_, now_ns);
  }
  differ(readable(request) + " was sent where " + captured + ": no answer");
}

// Leaves exchange_ before the one that answers the request; only questions how it stands are
// passed over.
bool CapturedDevice::found_among_questions(const std::string& request) {
  for (std::size_t next = exchange_ + 1; next < exchanges().size(); ++next) {
    if (exchanges()[next].request == request) {
      exchange_ = next - 1;
      return true;
    }
    if (!asks_how_it_stands(exchanges()[next].request)) return false;
  }
  return false;
}

bool CapturedDevice::found_later(const std::string& request) {
  for (std::size_t next = exchange_ + 1; next < exchanges().size(); ++next) {
    if (exchanges()[next].request != request) continue;
    exchange_ = next - 1;
    return true;
  }
  return false;
}

void CapturedDevice::differ(const std::string& words) {
  ++differences_;
  on_news_(name_ + ": " + words);
}

void CapturedDevice::advance(std::int64_t now_ns) {
  if (exchange_ >= exchanges().size()) return;
  const Exchange& exchange = exchanges()[exchange_];
  for (; answer_ < exchange.answers.size(); ++answer_) {
    const Answer& answer = exchange.answers[answer_];
    if (asked_ns_ + answer.delay_ns > now_ns) return;
    output_ += answer.bytes;
    hangs_up_ = hangs_up_ || answer.bytes.empty();
    if (asks_how_it_stands(exchange.request)) last_standing_ = answer.bytes;
  }
}

std::string CapturedDevice::take_output() {
  return std::exchange(output_, {});
}

bool CapturedDevice::takes_leave() {
  return std::exchange(hangs_up_, false);
}

std::int64_t CapturedDevice::next_event_ns(std::int64_t) const {
  if (exchange_ >= exchanges().size()) return kNever_ns;
  const std::vector<Answer>& answers = exchanges()[exchange_].answers;
  return answer_ < answers.size() ? asked_ns_ + answers[answer_].delay_ns : kNever_ns;
}

}  // namespace swivel::sim
