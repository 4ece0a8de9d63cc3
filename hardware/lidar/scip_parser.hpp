// Bytes to replies, however the bytes are cut. The grammar stands in scip.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace swivel::scip {

// A reply whose sums are right. Its texts stand one after the other, so that the values of
// a scan are whole.
struct Reply {
  std::string echo;
  std::string status;
  std::string texts;                   // without sums
  std::vector<std::size_t> text_ends;  // positions in `texts`

  std::size_t text_count() const { return text_ends.size(); }
  std::string_view text(std::size_t which) const;
  std::string_view texts_from(std::size_t which) const;  // that text and all after it
};

struct ParserCounters {
  std::uint64_t replies = 0;
  std::uint64_t bad_sums = 0;  // replies dropped for a wrong sum
  std::uint64_t resyncs = 0;   // replies dropped for any reason: the parser skips to their end
};

// Memory is bounded whatever comes. After damage, whatever stands before the next empty line
// is dropped, and counted as one.
class Parser {
 public:
  std::vector<Reply> push(std::string_view bytes);
  const ParserCounters& counters() const { return counters_; }

 private:
  enum class Expecting { kEcho, kStatus, kText, kEmptyLine };  // the last: skipping

  void end_line();
  void take_status();
  void take_text();
  void finish();
  void skip();
  bool sum_is_right(std::string_view text, char sum) const;

  Expecting expecting_ = Expecting::kEcho;
  std::string line_;
  bool line_too_long_ = false;
  Reply reply_;
  std::vector<Reply> finished_;
  ParserCounters counters_;
};

}  // namespace swivel::scip
