#include "hardware/sim/conversation.hpp"

#include <algorithm>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr std::int64_t kLongHole_ns = 300 * kMillisecond_ns;
constexpr std::int64_t kClosedHole_ns = 25 * kMillisecond_ns;  // a scan

// Puts the pieces of a capture together, one after the other.
class Composer {
 public:
  Composer(std::int64_t opened_ns, const std::string& at_once)
      : at_once_(at_once), request_ns_(opened_ns), last_ns_(opened_ns) {
    result_.exchanges.emplace_back();
  }

  void add(const CapturedPiece& piece) {
    if (piece.kind == CapturedPiece::Kind::kHungUp) return answer(piece.time_ns, {});
    const bool asks = piece.kind == CapturedPiece::Kind::kToDevice;
    std::uint64_t& known = asks ? asked_ : answered_;
    const std::uint64_t end = piece.offset + piece.bytes.size();
    if (end <= known) return;  // told before
    if (piece.offset > known) note_hole(piece.offset - known, piece.time_ns);
    const std::size_t told = known > piece.offset ? known - piece.offset : 0;
    known = end;
    asks ? ask(piece.time_ns, piece.bytes.substr(told))
         : answer(piece.time_ns, piece.bytes.substr(told));
    last_ns_ = piece.time_ns;
  }

  Conversation take() { return std::move(result_); }

 private:
  void note_hole(std::uint64_t bytes, std::int64_t time_ns) {
    result_.bytes_missing += bytes;
    if (time_ns - last_ns_ < kLongHole_ns) return;
    // What came first is the acknowledgement.
    std::vector<Answer>& answers = result_.exchanges.back().answers;
    const std::size_t kept = std::min<std::size_t>(1, answers.size());
    for (std::size_t answer = kept; answer < answers.size(); ++answer)
      result_.bytes_left_out += answers[answer].bytes.size();
    answers.resize(kept);
    const std::int64_t acknowledged_ns = kept == 0 ? 0 : answers.front().delay_ns;
    cut_ns_ = time_ns - kClosedHole_ns - acknowledged_ns - request_ns_;
    last_ns_ = time_ns;  // the other way has its hole at the same time
  }

  void ask(std::int64_t time_ns, const std::string& bytes) {
    unfinished_ += bytes;
    for (std::string request = take_request(unfinished_, at_once_); !request.empty();
         request = take_request(unfinished_, at_once_)) {
      result_.exchanges.push_back({std::move(request), {}, time_ns});
      request_ns_ = time_ns - cut_ns_;
    }
  }

  void answer(std::int64_t time_ns, std::string bytes) {
    result_.exchanges.back().answers.push_back(
        {std::max<std::int64_t>(0, time_ns - cut_ns_ - request_ns_), std::move(bytes), time_ns});
  }

  const std::string at_once_;
  Conversation result_;
  std::string unfinished_;   // request
  std::int64_t request_ns_;  // when the last one was sent, by the time without holes
  std::int64_t last_ns_;     // of the last piece
  std::int64_t cut_ns_ = 0;  // out of the holes so far
  std::uint64_t asked_ = 0;  // bytes
  std::uint64_t answered_ = 0;
};

}  // namespace

std::string take_request(std::string& bytes, const std::string& at_once) {
  std::size_t size = bytes.find_first_of("\n\r") + 1;  // 0: none
  const std::size_t character = at_once.empty() ? std::string::npos : bytes.find_first_of(at_once);
  if (character == 0) size = 1;
  std::string request = bytes.substr(0, size);
  bytes.erase(0, size);
  return request;
}

Conversation conversation_of(const std::vector<CapturedPiece>& pieces, std::int64_t opened_ns,
                             const std::string& at_once) {
  Composer composer(opened_ns, at_once);
  for (const CapturedPiece& piece : pieces) composer.add(piece);
  return composer.take();
}

}  // namespace swivel::sim
