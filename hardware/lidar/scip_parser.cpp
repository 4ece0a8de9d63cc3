#include "hardware/lidar/scip_parser.hpp"

#include <cassert>
#include <utility>

#include "hardware/lidar/scip.hpp"

namespace swivel::scip {
namespace {

// Key lines of real sensors pass 64 characters now and then; 10000 steps of ME need 938 texts.
constexpr std::size_t kLongestLine = 128;
constexpr std::size_t kMostTexts = 1024;

bool is_printable(std::string_view line) {
  for (const char character : line)
    if (character < 0x20 || character > 0x7E) return false;
  return true;
}

}  // namespace

std::string_view Reply::text(std::size_t which) const {
  assert(which < text_ends.size());
  const std::size_t start = which == 0 ? 0 : text_ends[which - 1];
  return std::string_view(texts).substr(start, text_ends[which] - start);
}

std::string_view Reply::texts_from(std::size_t which) const {
  assert(which <= text_ends.size());
  return std::string_view(texts).substr(which == 0 ? 0 : text_ends[which - 1]);
}

std::vector<Reply> Parser::push(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view part = bytes.substr(0, end);
    line_too_long_ = line_too_long_ || line_.size() + part.size() > kLongestLine;
    if (!line_too_long_) line_.append(part);
    if (end == std::string_view::npos) break;
    end_line();
    bytes.remove_prefix(end + 1);
  }
  return std::exchange(finished_, {});
}

void Parser::end_line() {
  const bool is_empty = line_.empty() && !line_too_long_;
  if (line_too_long_ || !is_printable(line_)) {
    skip();
  } else if (is_empty) {
    finish();
  } else if (expecting_ == Expecting::kEcho) {
    reply_.echo = line_;
    expecting_ = Expecting::kStatus;
  } else if (expecting_ == Expecting::kStatus) {
    take_status();
  } else if (expecting_ == Expecting::kText) {
    take_text();
  }
  line_.clear();
  line_too_long_ = false;
}

void Parser::take_status() {
  if (line_.size() != 3) return skip();
  reply_.status = line_.substr(0, 2);
  if (!sum_is_right(reply_.status, line_[2])) {
    ++counters_.bad_sums;
    return skip();
  }
  expecting_ = Expecting::kText;
}

void Parser::take_text() {
  const std::string_view text = std::string_view(line_).substr(0, line_.size() - 1);
  if (text.empty() || reply_.text_ends.size() == kMostTexts) return skip();
  if (!sum_is_right(text, line_.back())) {
    ++counters_.bad_sums;
    return skip();
  }
  reply_.texts.append(text);
  reply_.text_ends.push_back(reply_.texts.size());
}

// An empty line: the end of a reply, or of what is skipped. Before an echo it means nothing.
void Parser::finish() {
  if (expecting_ == Expecting::kText) {
    ++counters_.replies;
    finished_.push_back(std::move(reply_));
  } else if (expecting_ == Expecting::kStatus) {
    ++counters_.resyncs;
  }
  reply_ = Reply{};
  expecting_ = Expecting::kEcho;
}

void Parser::skip() {
  if (expecting_ != Expecting::kEmptyLine) ++counters_.resyncs;
  expecting_ = Expecting::kEmptyLine;
}

// The documents leave the semicolon out of the sum of KEY:value; and some sensors count it.
// Scans end in a semicolon by chance: for them there is one sum only.
bool Parser::sum_is_right(std::string_view text, char sum) const {
  if (checksum(text) == sum) return true;
  const bool has_keys = reply_.echo.size() >= 2 && reply_.echo[0] == reply_.echo[1];  // VV PP II
  return has_keys && text.back() == ';' && checksum(text.substr(0, text.size() - 1)) == sum;
}

}  // namespace swivel::scip
